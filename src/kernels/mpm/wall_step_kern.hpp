#pragma once

#include "backend/sort.hpp"
#include "kernels/mpm/grid_kern.hpp"

// The second half of the step of the nodes beside walls: axis after axis, so that edges and corners of the domain obey
// all their walls, the groups across a wall's plane are held (they share no node); then every node is finished.
namespace tread::mpm
{

/// A page of nodes: where it is, and which in the list of node pages.
struct HomePage
{
    Index3       at;
    std::int64_t number;
};

/// Number of the page that holds a node, -1 if none does; seldom another one than `home`.
TREAD_HD std::int64_t page_holding(const PagesView& pages, const HomePage& home, Index3 node)
{
    const Index3 at = page_of(node);
    if (at.x == home.at.x && at.y == home.at.y && at.z == home.at.z) { return home.number; }
    return find_sorted(pages.node_page_key, pages.node_pages, page_key(at));
}

/// Where a page keeps the motion of one of its nodes.
template<class Real>
TREAD_HD Real* motion_of(Real* motion, std::int64_t page, Index3 node)
{
    return motion + page * motion_channels * page_cells + place_in_page(node);
}

/// Mass and velocity, as far as it is known, of the nodes around a wall's plane, and where they are kept.
template<class Real>
struct FoundGroup
{
    WallGroup<Real> group;
    Real*           motion[3] = {nullptr, nullptr, nullptr};
};

template<class Real>
TREAD_HD FoundGroup<Real> find_group(const PagesView& pages, const HomePage& home, Index3 middle, int axis, int end,
                                     Real* motion)
{
    FoundGroup<Real> found;
    for (int i = 0; i < 3; ++i)
    {
        const Index3       node = beside(middle, axis, end == 0 ? i - 1 : 1 - i);
        const std::int64_t page = page_holding(pages, home, node);
        if (page < 0) { continue; }
        found.motion[i]         = motion_of(motion, page, node);
        found.group.mass[i]     = unfinished_mass(found.motion[i]);
        found.group.velocity[i] = read_velocity(found.motion[i]);
    }
    return found;
}

/// If a node stands on the plane of a wall across `axis`, the wall on its group.
template<class Real>
TREAD_HD void hold_group(const PagesView& pages, const HomePage& home, const GridWalls& walls, Index3 node, int axis,
                         Real* motion, double* sums)
{
    const WallPlace place = wall_place(walls, axis, along(node, axis));
    if (!place.paired || place.depth != 0) { return; }
    FoundGroup<Real> found = find_group(pages, home, node, axis, place.end, motion);
    book_friction(hold(walls, axis, place.end, found.group), sums);
    for (int i = 0; i < 3; ++i)
    {
        if (found.group.mass[i] > 0) { write_velocity(found.group.velocity[i], found.motion[i]); }
    }
}

/// If walls hold a node together with others, the end of its step. `tile_pages`: of its page, by octant.
template<class Real>
TREAD_HD void finish_held(const std::int32_t* tile_pages, const Real* tiles, const GridStep<Real>& step, Index3 node,
                          Real* motion, double* sums)
{
    if (!held_by(step.walls, node).paired || unfinished_mass(motion) == 0) { return; }
    Real channels[node_channels];
    sum_tiles(tile_pages, tiles, place_in_page(node), channels);
    finish_node(step, begin_node(step, node, channels), read_velocity(motion), motion, sums);
}

/// Whether walls hold nodes of a page together with others.
TREAD_HD bool is_wall_page(const GridWalls& walls, Index3 page)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        for (int i = 0; i < page_edge; ++i)
        {
            if (wall_place(walls, axis, along(page, axis) * page_edge + i).paired) { return true; }
        }
    }
    return false;
}

} // namespace tread::mpm
