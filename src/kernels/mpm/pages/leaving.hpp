#pragma once

#include "kernels/mpm/pages/order.hpp"
#include "kernels/mpm/points.hpp"

// Points on pages that other processes own.
namespace tread::mpm
{

/// Owners of the pages.
struct PageOwnersView
{
    std::int64_t         pages;
    const std::uint64_t* key;   ///< ascending
    const std::int32_t*  owner; ///< rank

    /// Returns the owner of a page; -1 if nobody owns it.
    TREAD_HD std::int32_t of(std::uint64_t page) const
    {
        const std::int64_t at = find_sorted(key, pages, page);
        return at < 0 ? -1 : owner[at];
    }
};

/// Points that migrate to other ranks, in memory order.
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
    Array<Exec, std::int32_t>  owner; ///< -1: nobody owns the point's page
    Array<Exec, std::uint64_t> page;  ///< page key
    Array<Exec, std::int32_t>  mark;  ///< scratch
};

/// Finds the points whose page this rank (`self`) does not own. Points that order_points will drop are not included.
template<class Exec, class Real>
void find_leaving(const Exec& exec, Points<Exec, Real>& points, const GridGeometry& geometry,
                  const PageOwnersView& owners, std::int32_t self, Leaving<Exec>& leaving,
                  OrderScratch<Exec, Real>& scratch);

/// Removes the leaving points and closes the gaps; the order of the others is kept.
template<class Exec, class Real>
void remove_leaving(const Exec& exec, Points<Exec, Real>& points, const Leaving<Exec>& leaving,
                    OrderScratch<Exec, Real>& scratch);

} // namespace tread::mpm
