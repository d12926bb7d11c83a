#pragma once

#include "kernels/mpm/pages/order.hpp"
#include "kernels/mpm/points.hpp"

// Points whose pages belong to other processes.
namespace tread::mpm
{

/// Who owns which page.
struct PageOwnersView
{
    std::int64_t         pages;
    const std::uint64_t* key;   ///< ascending
    const std::int32_t*  owner; ///< a rank

    /// -1 of a page that nobody owns.
    TREAD_HD std::int32_t of(std::uint64_t page) const
    {
        const std::int64_t at = find_sorted(key, pages, page);
        return at < 0 ? -1 : owner[at];
    }
};

/// Points that are to leave, in the order in which they stand in memory.
template<class Exec>
struct Leaving
{
    explicit Leaving(const Exec& exec)
        : row(exec, "leaving points")
        , owner(exec, "owners of leaving points")
        , page(exec, "pages of leaving points")
        , mark(exec, "marks of leaving points")
    {
    }

    Array<Exec, std::int32_t>  row;
    Array<Exec, std::int32_t>  owner; ///< -1: of a page that nobody owns
    Array<Exec, std::uint64_t> page;  ///< key
    Array<Exec, std::int32_t>  mark;  ///< scratch
};

/// Finds the points whose page is not `self`'s. Those that order_points will drop stay.
template<class Exec, class Real>
void find_leaving(const Exec& exec, Points<Exec, Real>& points, const GridGeometry& geometry,
                  const PageOwnersView& owners, std::int32_t self, Leaving<Exec>& leaving,
                  OrderScratch<Exec, Real>& scratch);

/// Takes the leaving points out; the others move up in their order.
template<class Exec, class Real>
void remove_leaving(const Exec& exec, Points<Exec, Real>& points, const Leaving<Exec>& leaving,
                    OrderScratch<Exec, Real>& scratch);

} // namespace tread::mpm
