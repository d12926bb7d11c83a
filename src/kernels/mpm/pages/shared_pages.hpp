#pragma once

#include "backend/array.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/transfers/tile_kern.hpp"

namespace tread::mpm
{

/// Number of P2G values per node page.
constexpr int node_page_values = node_channels * page_cells;

/// Node pages to which points of several processes contribute ("shared pages").
template<class Real>
struct SharedPagesView
{
    const std::int32_t* number_of; ///< [node pages], its shared page, or -1; null if there are none
    const Real*         total;     ///< [shared pages][node_channels][page_cells], sums over all processes

    TREAD_HD std::int32_t number(std::int64_t node_page) const
    {
        return number_of == nullptr ? -1 : number_of[node_page];
    }
};

/// Memory of SharedPagesView and of its summands.
template<class Exec, class Real>
struct SharedPages
{
    explicit SharedPages(const Exec& exec)
        : page(exec, "shared pages")
        , number_of(exec, "shared pages of node pages")
        , own(exec, "own parts of shared pages")
        , total(exec, "totals of shared pages")
        , first_part(exec, "shared page first part")
        , part(exec, "shared page parts")
        , tallied_elsewhere(exec, "shared pages tallied elsewhere")
    {
    }

    SharedPagesView<Real> view() const { return {number_of.data(), total.data()}; }

    Array<Exec, std::int32_t> page;       ///< [shared pages], node page, ascending
    Array<Exec, std::int32_t> number_of;  ///< [node pages]
    Array<Exec, Real>         own;        ///< [shared pages][node_page_values], contributions of this process's tiles
    Array<Exec, Real>         total;      ///< [shared pages][node_page_values]
    Array<Exec, std::int32_t> first_part; ///< [shared pages + 1]
    Array<Exec, std::int32_t> part; ///< of a page, in the order of summation: index of a received part, or -1 = own
    Array<Exec, std::int32_t> tallied_elsewhere; ///< node pages whose tallies another process keeps
};

/// Computes SharedPages::own from the tiles.
template<class Exec, class Real>
void sum_own_parts(const Exec& exec, const PagesView& pages, const Real* tiles, SharedPages<Exec, Real>& shared);

/// Computes SharedPages::total: sums the parts of every page in order. `arrived`: [parts of others][node_page_values].
template<class Exec, class Real>
void add_parts(const Exec& exec, const Real* arrived, SharedPages<Exec, Real>& shared);

/// Clears the tallies (`width` numbers per node page) of pages whose tallies another process keeps.
template<class Exec, class Real>
void clear_tallied_elsewhere(const Exec& exec, const SharedPages<Exec, Real>& shared, int width, double* tallies);

} // namespace tread::mpm
