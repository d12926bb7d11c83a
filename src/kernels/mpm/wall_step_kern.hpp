#pragma once

#include "backend/sort.hpp"
#include "kernels/mpm/grid_kern.hpp"

// The second half of the step of the nodes beside walls: owner after owner (owns_pairs), each with the up to 27 nodes
// that are its own, so that owners do not depend on each other; within an owner axis after axis, so that edges and
// corners of the domain obey all their walls.
namespace tread::mpm
{

/// Velocity and mass of the group whose middle is `node`, as far as they are known, and where they are kept.
template<class Real>
struct FoundGroup
{
    WallGroup<Real> group;
    Real*           motion[3] = {nullptr, nullptr, nullptr};
};

/// Where a node's motion is; nullptr if it is in no page.
template<class Real>
TREAD_HD Real* node_motion(const PagesView& pages, Index3 node, Real* motion)
{
    const std::int64_t page = find_sorted(pages.node_page_key, pages.node_pages, page_key(page_of(node)));
    return page < 0 ? nullptr : motion + page * motion_channels * page_cells + place_in_page(node);
}

/// Sum of the first `count` channels of the tiles of the node that keeps its motion at `kept`.
template<int count, class Real>
TREAD_HD void sum_tiles_of(const PagesView& pages, const Real* tiles, const Real* motion, const Real* kept, Real* total)
{
    const std::int64_t at = kept - motion, page = at / (motion_channels * page_cells);
    std::int32_t       tile_pages[octants];
    for (int octant = 0; octant < octants; ++octant) { tile_pages[octant] = tile_page(pages, page, octant); }
    sum_tiles<count>(tile_pages, tiles, static_cast<int>(at % (motion_channels * page_cells)), total);
}

template<class Real>
TREAD_HD FoundGroup<Real> find_group(const PagesView& pages, const Real* tiles, Real mass_floor, Index3 node, int axis,
                                     int end, Real* motion)
{
    FoundGroup<Real> found;
    for (int i = 0; i < 3; ++i)
    {
        Real* kept = node_motion(pages, beside(node, axis, end == 0 ? i - 1 : 1 - i), motion);
        if (kept == nullptr) { continue; }
        Real mass;
        sum_tiles_of<1>(pages, tiles, motion, kept, &mass);
        found.motion[i]         = kept;
        found.group.mass[i]     = mass > mass_floor ? mass : Real(0);
        found.group.velocity[i] = read_velocity(kept);
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
TREAD_HD void hold_groups(const PagesView& pages, const Real* tiles, const GridStep<Real>& step, Index3 owner, int axis,
                          Real* motion, double* sums)
{
    const WallPlace place = wall_place(step.walls, axis, along(owner, axis));
    if (!place.paired) { return; }
    Reach reach                                           = reach_of(step.walls, owner);
    (axis == 0 ? reach.x : axis == 1 ? reach.y : reach.z) = 0;
    const auto hold_group                                 = [&](Index3 middle)
    {
        FoundGroup<Real> found = find_group(pages, tiles, step.mass_floor, middle, axis, place.end, motion);
        book_friction(hold(step.walls, axis, place.end, found.group), sums);
        for (int i = 0; i < 3; ++i)
        {
            if (found.motion[i] != nullptr) { write_velocity(found.group.velocity[i], found.motion[i]); }
        }
    };
    for_each_node(owner, reach, hold_group);
}

/// Finishes all nodes of the owner `owner`.
template<class Real>
TREAD_HD void update_owned(const PagesView& pages, const Real* tiles, const GridStep<Real>& step, Index3 owner,
                           Real* motion, double* sums)
{
    for (int axis = 0; axis < 3; ++axis) { hold_groups(pages, tiles, step, owner, axis, motion, sums); }
    const auto finish = [&](Index3 node)
    {
        Real* kept = node_motion(pages, node, motion);
        if (kept == nullptr) { return; }
        Real channels[node_channels];
        sum_tiles_of<node_channels>(pages, tiles, motion, kept, channels);
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
