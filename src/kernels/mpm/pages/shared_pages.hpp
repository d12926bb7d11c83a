#pragma once

#include "backend/array.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/transfers/tile_kern.hpp"

namespace tread::mpm
{

/// What points bring to the nodes of a page.
constexpr int node_page_values = node_channels * page_cells;

/// Node pages to which points of other processes bring something, too ("shared pages").
template<class Real>
struct SharedPagesView
{
    const std::int32_t* number_of; ///< [node pages], its shared page, or -1; null where there are none
    const Real*         total;     ///< [shared pages][node_channels][page_cells], what all processes bring

    TREAD_HD std::int32_t number(std::int64_t node_page) const
    {
        return number_of == nullptr ? -1 : number_of[node_page];
    }
};

/// Owner of what SharedPagesView shows, and of what it is added up from.
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
        , booked_elsewhere(exec, "shared pages booked elsewhere")
    {
    }

    SharedPagesView<Real> view() const { return {number_of.data(), total.data()}; }

    Array<Exec, std::int32_t> page;       ///< [shared pages], node page, ascending
    Array<Exec, std::int32_t> number_of;  ///< [node pages]
    Array<Exec, Real>         own;        ///< [shared pages][node_page_values], what the tiles here bring
    Array<Exec, Real>         total;      ///< [shared pages][node_page_values]
    Array<Exec, std::int32_t> first_part; ///< [shared pages + 1]
    Array<Exec, std::int32_t> part; ///< of a page, in the order of adding: the number of an arrived one, or -1 = own
    Array<Exec, std::int32_t> booked_elsewhere; ///< node pages whose tallies another process keeps
};

/// Writes SharedPages::own from the tiles.
template<class Real>
void sum_own_parts(const Cpu&, const PagesView& pages, const Real* tiles, SharedPages<Cpu, Real>& shared);
template<class Real>
void sum_own_parts(const Gpu&, const PagesView& pages, const Real* tiles, SharedPages<Gpu, Real>& shared);

/// Writes SharedPages::total: the parts of every page in their order. `arrived`: [parts of others][node_page_values].
template<class Real>
void add_parts(const Cpu&, const Real* arrived, SharedPages<Cpu, Real>& shared);
template<class Real>
void add_parts(const Gpu&, const Real* arrived, SharedPages<Gpu, Real>& shared);

/// Clears the tallies (`width` numbers a node page) of pages that are booked elsewhere.
template<class Real>
void clear_booked_elsewhere(const Cpu&, const SharedPages<Cpu, Real>& shared, int width, double* tallies);
template<class Real>
void clear_booked_elsewhere(const Gpu&, const SharedPages<Gpu, Real>& shared, int width, double* tallies);

} // namespace tread::mpm
