#pragma once

#include "backend/sort.hpp"
#include "kernels/mpm/grid_kern.hpp"

// The second half of the step of the nodes beside walls: owner after owner (owns_pairs), each with the up to 27 nodes
// that are its own, so that owners do not depend on each other; within an owner axis after axis, so that edges and
// corners of the domain obey all their walls.
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

/// How far an owner's nodes reach from it along each axis, 0 or 1.
struct Reach
{
    int x, y, z;
};

TREAD_HD Reach reach_of(const GridWalls& walls, Index3 owner)
{
    return {wall_place(walls, 0, owner.x).paired ? 1 : 0, wall_place(walls, 1, owner.y).paired ? 1 : 0,
            wall_place(walls, 2, owner.z).paired ? 1 : 0};
}

/// Calls f(node) for every node within reach of `owner`.
template<class F>
TREAD_HD void for_each_node(Index3 owner, Reach reach, F f)
{
    for (int z = -reach.z; z <= reach.z; ++z)
    {
        for (int y = -reach.y; y <= reach.y; ++y)
        {
            for (int x = -reach.x; x <= reach.x; ++x) { f(Index3{owner.x + x, owner.y + y, owner.z + z}); }
        }
    }
}

/// The wall that pairs `owner` along `axis` on all its groups.
template<class Real>
TREAD_HD void hold_groups(const PagesView& pages, const HomePage& home, const GridWalls& walls, Index3 owner, int axis,
                          Real* motion, double* sums)
{
    const WallPlace place = wall_place(walls, axis, along(owner, axis));
    if (!place.paired) { return; }
    Reach reach                                           = reach_of(walls, owner);
    (axis == 0 ? reach.x : axis == 1 ? reach.y : reach.z) = 0;
    const auto hold_group                                 = [&](Index3 middle)
    {
        FoundGroup<Real> found = find_group(pages, home, middle, axis, place.end, motion);
        book_friction(hold(walls, axis, place.end, found.group), sums);
        for (int i = 0; i < 3; ++i)
        {
            if (found.group.mass[i] > 0) { write_velocity(found.group.velocity[i], found.motion[i]); }
        }
    };
    for_each_node(owner, reach, hold_group);
}

/// Finishes all nodes that a node of page `home` owns.
template<class Real>
TREAD_HD void update_owned(const PagesView& pages, const HomePage& home, const Real* tiles, const GridStep<Real>& step,
                           Index3 owner, Real* motion, double* sums)
{
    for (int axis = 0; axis < 3; ++axis) { hold_groups(pages, home, step.walls, owner, axis, motion, sums); }
    const auto finish = [&](Index3 node)
    {
        const std::int64_t page = page_holding(pages, home, node);
        if (page < 0) { return; }
        Real* kept = motion_of(motion, page, node);
        if (unfinished_mass(kept) == 0) { return; }
        std::int32_t tile_pages[octants];
        for (int octant = 0; octant < octants; ++octant) { tile_pages[octant] = tile_page(pages, page, octant); }
        Real channels[node_channels];
        sum_tiles(tile_pages, tiles, place_in_page(node), channels);
        finish_node(step, begin_node(step, node, channels), read_velocity(kept), kept, sums);
    };
    for_each_node(owner, reach_of(step.walls, owner), finish);
}

/// Whether any node of a page may own pairs.
TREAD_HD bool touches_wall(const GridWalls& walls, Index3 page)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        if (is_thin(walls, axis)) { continue; }
        const std::int32_t first = along(page, axis) * page_edge, wall[2] = {0, walls.last_node[axis]};
        for (int end = 0; end < 2; ++end)
        {
            if (walls.rule[axis][end] != WallRule::open && wall[end] >= first && wall[end] < first + page_edge)
            {
                return true;
            }
        }
    }
    return false;
}

} // namespace tread::mpm
