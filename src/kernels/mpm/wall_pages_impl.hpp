#pragma once

#include "kernels/mpm/wall_kern.hpp"
#include "kernels/mpm/wall_pages.hpp"

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
        marks[i] = has_held_nodes(walls, page_coordinates(pages.node_page_key[i]));
    }
};

/// After the scan number_of[i] counts the wall pages before i.
struct WriteWallPage
{
    PagesView     pages;
    GridWalls     walls;
    std::int32_t* number_of;
    std::int32_t* page;

    TREAD_HD void operator()(std::int64_t i) const
    {
        if (has_held_nodes(walls, page_coordinates(pages.node_page_key[i])))
        {
            page[number_of[i]] = static_cast<std::int32_t>(i);
        }
        else { number_of[i] = -1; }
    }
};

struct FindWallPage
{
    PagesView           pages;
    const std::int32_t* page;
    const std::int32_t* number_of;
    std::int32_t*       neighbour;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const Index3       from = page_coordinates(pages.node_page_key[page[i / directions]]);
        const int          d    = static_cast<int>(i % directions);
        const Index3       to{from.x + d % 3 - 1, from.y + d / 3 % 3 - 1, from.z + d / 9 - 1};
        const std::int64_t found = find_sorted(pages.node_page_key, pages.node_pages, page_key(to));
        neighbour[i]             = found < 0 ? -1 : number_of[found];
    }
};

template<class Exec, class Real>
void list_wall_pages(const Exec& exec, const PagesView& pages, const GridWalls& walls,
                     WallPages<Exec, Real>& wall_pages, SortScratch<Exec>& scratch)
{
    auto& [page, number_of, neighbour, node] = wall_pages;
    number_of.resize(pages.node_pages);
    for_each(exec, "mark wall pages", pages.node_pages, MarkWallPage{pages, walls, number_of.data()});
    page.resize(exclusive_scan(exec, number_of, scratch));
    for_each(exec, "write wall pages", pages.node_pages, WriteWallPage{pages, walls, number_of.data(), page.data()});
    neighbour.resize(directions * page.size());
    for_each(exec, "find wall pages", neighbour.size(),
             FindWallPage{pages, page.data(), number_of.data(), neighbour.data()});
    node.resize(page_cells * page.size());
}

} // namespace tread::mpm
