#pragma once

#include "kernels/mpm/wall_pages.hpp"
#include "kernels/mpm/wall_step_kern.hpp"

// list_wall_pages, the same on both backends; wall_pages.cpp and wall_pages.cu bring in for_each and instantiate.
namespace tread::mpm
{

struct MarkWallPage
{
    PagesView     pages;
    GridWalls     walls;
    std::int32_t* marks;

    TREAD_HD void operator()(std::int64_t i) const
    {
        marks[i] = is_wall_page(walls, page_coordinates(pages.node_page_key[i]));
    }
};

/// After the scan marks[i] counts the wall pages before i.
struct WriteWallPage
{
    PagesView           pages;
    GridWalls           walls;
    const std::int32_t* before;
    std::int32_t*       list;

    TREAD_HD void operator()(std::int64_t i) const
    {
        if (!is_wall_page(walls, page_coordinates(pages.node_page_key[i]))) { return; }
        list[before[i]] = static_cast<std::int32_t>(i);
    }
};

template<class Exec>
void list_wall_pages(const Exec& exec, const PagesView& pages, const GridWalls& walls, Array<Exec, std::int32_t>& list,
                     Array<Exec, std::int32_t>& marks, SortScratch<Exec>& scratch)
{
    marks.resize(pages.node_pages);
    for_each(exec, "mark wall pages", pages.node_pages, MarkWallPage{pages, walls, marks.data()});
    list.resize(exclusive_scan(exec, marks, scratch));
    for_each(exec, "write wall pages", pages.node_pages, WriteWallPage{pages, walls, marks.data(), list.data()});
}

} // namespace tread::mpm
