#pragma once

#include <algorithm>
#include <utility>

#include "kernels/mpm/relist.hpp"
#include "kernels/mpm/relist_kern.hpp"

// The steps of relist_points, the same on both backends; relist.cpp and relist.cu bring in for_each and instantiate.
namespace tread::mpm
{

/// Writes list and cell ranges of every page.
void relist_pages(const Cpu& cpu, const Relisting& job);
void relist_pages(const Gpu& gpu, const Relisting& job);

struct CloseCells
{
    const std::int32_t* points;
    std::int32_t*       last;

    TREAD_HD void operator()(std::int64_t) const { *last = *points; }
};

template<class Exec>
void relist_points(const Exec& exec, Pages<Exec>& pages, const MovesView& moves, RelistScratch<Exec>& scratch)
{
    const PagesView    old   = pages.view(1, 0);
    const std::int64_t count = old.point_pages;
    scratch.first_point.resize(count + 1);
    scratch.cell_first_point.resize(count * page_cells + 1);
    scratch.point_at.resize(pages.point_at.size());
    scratch.place_at.resize(pages.place_at.size());
    for_each(exec, "count pages", count + 1, CountAfter{old, moves, scratch.first_point.data()});
    scan_in_place(exec, scratch.first_point, scratch.sort);
    for_each(exec, "close cells", 1,
             CloseCells{scratch.first_point.data() + count, scratch.cell_first_point.data() + count * page_cells});
    relist_pages(exec, {old, moves, scratch.first_point.data(), scratch.cell_first_point.data(),
                        scratch.point_at.data(), scratch.place_at.data()});
    pages.first_point.swap(scratch.first_point);
    pages.cell_first_point.swap(scratch.cell_first_point);
    pages.point_at.swap(scratch.point_at);
    pages.place_at.swap(scratch.place_at);
}

} // namespace tread::mpm
