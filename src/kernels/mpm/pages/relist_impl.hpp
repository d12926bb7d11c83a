#pragma once

#include <algorithm>
#include <utility>

#include "kernels/mpm/pages/relist.hpp"
#include "kernels/mpm/pages/relist_kern.hpp"

// Steps of relist_points, for both backends; relist.cpp and relist.cu provide for_each and instantiate.
namespace tread::mpm
{

/// Whether points may have changed cell; may return true where the answer would need a wait for the device.
template<class Exec>
bool may_have_changed_cells(const Exec& exec, const MovesView& moves);

/// Writes first_point: the number of points before each page and, last, the total, after the moves.
template<class Exec>
void start_pages(const Exec& exec, const PagesView& old, const MovesView& moves, RelistScratch<Exec>& scratch);

/// Writes the list and the cell ranges of every page.
template<class Exec>
void relist_pages(const Exec& exec, const Relisting& job);

/// Stride with which each thread copies entries: if nothing moved, only few threads should be needed to find that out.
constexpr std::int64_t take_over_stride = 1 << 18;

/// Copies the new list into the arrays of the pages.
struct TakeOver
{
    MovesView           moves;
    std::int64_t        point_pages;
    std::int64_t        points;
    std::int64_t        items;
    const std::int32_t* first_point;
    const std::int32_t* cell_first_point;
    const std::int32_t* point_at;
    const std::uint8_t* place_at;
    std::int32_t*       own_first_point;
    std::int32_t*       own_cell_first_point;
    std::int32_t*       own_point_at;
    std::uint8_t*       own_place_at;

    TREAD_HD void operator()(std::int64_t first) const
    {
        if (!moves.any_changed_cell()) { return; }
        for (std::int64_t i = first; i < items; i += take_over_stride) { take_over(i); }
    }

    TREAD_HD void take_over(std::int64_t i) const
    {
        const std::int64_t cells = point_pages * page_cells;
        if (i <= point_pages) { own_first_point[i] = first_point[i]; }
        if (i <= cells) { own_cell_first_point[i] = i < cells ? cell_first_point[i] : first_point[point_pages]; }
        if (i < points)
        {
            own_point_at[i] = point_at[i];
            own_place_at[i] = place_at[i];
        }
    }
};

template<class Exec>
void relist_points(const Exec& exec, Pages<Exec>& pages, const MovesView& moves, RelistScratch<Exec>& scratch,
                   Array<Exec, std::uint64_t>& room)
{
    if (!may_have_changed_cells(exec, moves)) { return; }
    const PagesView    old   = pages.view(1, 0);
    const std::int64_t count = old.point_pages;
    scratch.first_point.resize(count + 1);
    scratch.cell_first_point.resize(count * page_cells + 1);
    const std::int64_t points = pages.point_at.size(), items = std::max(points, count * page_cells + 1);
    room.resize(points);
    auto* point_at = reinterpret_cast<std::int32_t*>(room.data());
    auto* place_at = reinterpret_cast<std::uint8_t*>(point_at + points);
    start_pages(exec, old, moves, scratch);
    relist_pages(exec, {old, moves, scratch.first_point.data(), scratch.cell_first_point.data(), point_at, place_at});
    for_each(exec, "take over list", std::min(items, take_over_stride),
             TakeOver{moves, count, points, items, scratch.first_point.data(), scratch.cell_first_point.data(),
                      point_at, place_at, pages.first_point.data(), pages.cell_first_point.data(),
                      pages.point_at.data(), pages.place_at.data()});
}

} // namespace tread::mpm
