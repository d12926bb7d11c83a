#pragma once

#include "kernels/mpm/grid/wall_kern.hpp"
#include "kernels/mpm/grid/wall_pages.hpp"
#include "kernels/mpm/pages/numbered_pages_impl.hpp"

// list_wall_pages, for both backends; wall_pages.cpp and wall_pages.cu provide for_each and instantiate.
namespace tread::mpm
{

struct IsWallPage
{
    PagesView pages;
    GridWalls walls;

    TREAD_HD bool operator()(std::int64_t i) const
    {
        return has_held_nodes(walls, page_coordinates(pages.node_page_key[i]));
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
        const Index3       from  = page_coordinates(pages.node_page_key[page[i / directions]]);
        const std::int32_t found = find_node_page(pages, page_towards(from, static_cast<int>(i % directions)));
        neighbour[i]             = found < 0 ? -1 : number_of[found];
    }
};

template<class Exec, class Real>
void list_wall_pages(const Exec& exec, const PagesView& pages, const GridWalls& walls,
                     WallPages<Exec, Real>& wall_pages, SortScratch<Exec>& scratch)
{
    auto& [page, number_of, neighbour, node] = wall_pages;
    number_pages(exec, pages, IsWallPage{pages, walls}, "mark wall pages", "write wall pages", page, number_of,
                 scratch);
    neighbour.resize(directions * page.size());
    for_each(exec, "find wall pages", neighbour.size(),
             FindWallPage{pages, page.data(), number_of.data(), neighbour.data()});
    node.resize(page_cells * page.size());
}

} // namespace tread::mpm
