#pragma once

#include "kernels/mpm/grid/grid_kern.hpp"
#include "kernels/mpm/pages/shared_pages.hpp"

// Parts and totals of shared pages, for both backends; shared_pages.cpp and shared_pages.cu provide for_each and
// instantiate.
namespace tread::mpm
{

/// Sums the tiles of this process; an item is a node of a shared page.
template<class Real>
struct SumOwnPart
{
    PagesView           pages;
    const std::int32_t* page;
    const Real*         tiles;
    Real*               own;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t number = i / page_cells;
        const int          place  = static_cast<int>(i % page_cells);
        std::int32_t       tile_pages[octants];
        for (int octant = 0; octant < octants; ++octant)
        {
            tile_pages[octant] = tile_page(pages, page[number], octant);
        }
        Real channels[node_channels];
        sum_tiles(tile_pages, tiles, place, channels);
        Real* to = own + number * node_page_values + place;
        for (int c = 0; c < node_channels; ++c) { to[c * page_cells] = channels[c]; }
    }
};

/// Sums the parts of all processes; an item is a value of a shared page.
template<class Real>
struct AddParts
{
    const Real*         own;
    const Real*         arrived;
    const std::int32_t* first_part;
    const std::int32_t* part;
    Real*               total;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t number = i / node_page_values, value = i % node_page_values;
        Real               sum = 0;
        for (std::int32_t p = first_part[number]; p < first_part[number + 1]; ++p)
        {
            sum += part[p] < 0 ? own[i] : arrived[part[p] * std::int64_t{node_page_values} + value];
        }
        total[i] = sum;
    }
};

struct ClearRow
{
    const std::int32_t* page;
    int                 width;
    double*             tallies;

    TREAD_HD void operator()(std::int64_t i) const { tallies[page[i / width] * std::int64_t{width} + i % width] = 0; }
};

template<class Exec, class Real>
void sum_own_parts(const Exec& exec, const PagesView& pages, const Real* tiles, SharedPages<Exec, Real>& shared)
{
    for_each(exec, "own parts of shared pages", shared.page.size() * page_cells,
             SumOwnPart<Real>{pages, shared.page.data(), tiles, shared.own.data()});
}

template<class Exec, class Real>
void add_parts(const Exec& exec, const Real* arrived, SharedPages<Exec, Real>& shared)
{
    for_each(
        exec, "add parts of shared pages", shared.page.size() * node_page_values,
        AddParts<Real>{shared.own.data(), arrived, shared.first_part.data(), shared.part.data(), shared.total.data()});
}

template<class Exec, class Real>
void clear_tallied_elsewhere(const Exec& exec, const SharedPages<Exec, Real>& shared, int width, double* tallies)
{
    for_each(exec, "clear tallies of other ranks", shared.tallied_elsewhere.size() * width,
             ClearRow{shared.tallied_elsewhere.data(), width, tallies});
}

} // namespace tread::mpm
