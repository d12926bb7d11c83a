#pragma once

#include "kernels/mpm/grid/grid_kern.hpp"

// Second half of the step of nodes next to walls. Axis by axis, so that edges and corners of the domain satisfy all
// their walls, the groups across a wall's plane are constrained (they share no node); then every node is completed. A
// page does so in a copy for all nodes that are constrained together with its own, so that pages are independent of
// each other.
namespace tread::mpm
{

/// Nodes that a page needs: its own and, along each axis across which walls constrain some of them together with
/// others, two more on each side. Coordinates are relative to the page's lowest node.
struct WallRegion
{
    bool paired[3];
    int  low[3];
    int  bits[3];  ///< log2 of the edges, which are 4 or 8 nodes
    int  shift[3]; ///< stride along an axis in the region is 1 << shift
    int  nodes;
};

constexpr int wall_reach        = 2;
constexpr int wall_region_nodes = 512;

TREAD_HD WallRegion wall_region(const GridWalls& walls, Index3 page)
{
    WallRegion region{};
    int        bits = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        region.paired[axis] = has_paired_nodes(walls, page, axis);
        region.low[axis]    = region.paired[axis] ? -wall_reach : 0;
        region.bits[axis]   = region.paired[axis] ? 3 : 2;
        region.shift[axis]  = bits;
        bits += region.bits[axis];
    }
    region.nodes = 1 << bits;
    return region;
}

TREAD_HD int region_coordinate(const WallRegion& region, int item, int axis)
{
    return region.low[axis] + (item >> region.shift[axis] & ((1 << region.bits[axis]) - 1));
}

TREAD_HD Index3 region_node(const WallRegion& region, int item)
{
    return {region_coordinate(region, item, 0), region_coordinate(region, item, 1), region_coordinate(region, item, 2)};
}

/// Returns the index in the region of a page's own node.
TREAD_HD int region_item(const WallRegion& region, int place)
{
    return (((place & 3) - region.low[0]) << region.shift[0]) +
           (((place >> 2 & 3) - region.low[1]) << region.shift[1]) +
           (((place >> 4) - region.low[2]) << region.shift[2]);
}

/// Result of wall_plane if the region does not contain the plane.
constexpr int no_plane = -100;

/// Returns the position along `axis` of the plane of the wall at `end` in the region of `page`, if the region has a
/// node on each side of it; otherwise no_plane.
TREAD_HD int wall_plane(const GridWalls& walls, Index3 page, const WallRegion& region, int axis, int end)
{
    if (walls.rule[axis][end] == WallRule::open) { return no_plane; }
    const int at = (end == 0 ? 0 : walls.last_node[axis]) - along(page, axis) * page_edge;
    return at > region.low[axis] && at < region.low[axis] + (1 << region.bits[axis]) - 1 ? at : no_plane;
}

/// Returns a node of the region of wall page `number`, as update_grid left it.
template<class Real>
TREAD_HD WallNode<Real> wall_node(const WallPagesView<Real>& pages, std::int64_t number, Index3 node)
{
    const auto side      = [](int at) { return at < 0 ? -1 : at >= page_edge ? 1 : 0; };
    const int  direction = own_page + side(node.x) + 3 * side(node.y) + 9 * side(node.z);
    const auto page      = pages.neighbour[number * directions + direction];
    if (page < 0) { return {}; }
    return pages.node[std::int64_t(page) * page_cells + place_in_page(node)];
}

template<class Real>
TREAD_HD Vec3<Real> velocity_of(const WallNode<Real>& node)
{
    return {node.at[1], node.at[2], node.at[3]};
}

/// Applies the wall at `end` of `axis`, whose plane is at `plane` along it, to the group of node `item` of the plane.
template<class Real, class Sum>
TREAD_HD void hold_group(const GridWalls& walls, const WallRegion& region, int axis, int end, int plane, int item,
                         WallNode<Real>* nodes, Sum* sums)
{
    const int shift = region.shift[axis], below = item & ((1 << shift) - 1);
    const int middle = below + ((plane - region.low[axis]) << shift) + ((item >> shift) << (shift + region.bits[axis]));
    const int inwards = end == 0 ? 1 << shift : -(1 << shift);
    WallGroup<Real> group;
    for (int i = 0; i < 3; ++i)
    {
        const WallNode<Real>& node = nodes[middle + (i - 1) * inwards];
        group.mass[i]              = node.at[0];
        group.velocity[i]          = velocity_of(node);
    }
    const double friction = hold(walls, axis, end, group);
    const Index3 home     = page_of(region_node(region, middle));
    if (home.x == 0 && home.y == 0 && home.z == 0) { account_friction(friction, sums); }
    for (int i = 0; i < 3; ++i)
    {
        if (group.mass[i] == 0) { continue; }
        for (int c = 0; c < 3; ++c) { nodes[middle + (i - 1) * inwards].at[1 + c] = group.velocity[i][c]; }
    }
}

/// Completes the step of a node of the page, if walls constrain it together with others.
template<class Real, class Sum>
TREAD_HD void finish_wall_node(const GridStep<Real>& step, const WallNode<Real>& held, Real* motion, Sum* sums)
{
    if (held.at[0] == 0) { return; }
    write_motion(finish_held(step, held.at[0], read_motion(motion), velocity_of(held), sums), motion);
}

} // namespace tread::mpm
