#pragma once

#include "kernels/mpm/grid/grid_kern.hpp"
#include "kernels/mpm/grid/seams.hpp"

namespace tread::mpm
{

/// Weight of child c (0..3) of a node along an axis.
template<class Real>
TREAD_HD Real child_share(int c)
{
    return c == 0 || c == 3 ? Real(0.25) : Real(0.75);
}

/// Adds the contributions of the slave nodes among the children of node `place` of a page to `total`. `child`: seam
/// pages of the next level, by direction; `totals`: of all seam pages.
template<class Real>
TREAD_HD void add_children(const Refinement& refinement, Index3 page, int place, const std::int32_t* child,
                           const Real* totals, Real* total)
{
    const int    level = level_of(page) + 1;
    const Index3 own = plain_node(page, place), base = plain_page(page);
    for (int n = 0; n < 64; ++n)
    {
        const int    c[] = {n & 3, n >> 2 & 3, n >> 4};
        const Index3 node{2 * own.x - 2 + c[0], 2 * own.y - 2 + c[1], 2 * own.z - 2 + c[2]};
        const Index3 on         = page_of(node);
        const int    direction  = own_page + (on.x - 2 * base.x) + 3 * (on.y - 2 * base.y) + 9 * (on.z - 2 * base.z);
        const std::int32_t from = child[direction];
        if (from < 0 || !is_slave(refinement, level, shifted_by(node, level_offset(level) * page_edge))) { continue; }
        const Real  share   = child_share<Real>(c[0]) * child_share<Real>(c[1]) * child_share<Real>(c[2]);
        const Real* brought = totals + std::int64_t(from) * node_page_values + place_in_page(node);
        for (int k = 0; k < node_channels; ++k) { total[k * page_cells] += share * brought[k * page_cells]; }
    }
}

/// Returns the motion of a slave node from its parents. `parent`: node pages by octant.
template<class Real>
TREAD_HD NodeEnd<Real> follow_parents(Index3 page, int place, const std::int32_t* parent, const Real* motion)
{
    const Index3  own = plain_node(page, place), base = plain_page(page);
    NodeEnd<Real> sum;
    for (int n = 0; n < 8; ++n)
    {
        const int    d[] = {n & 1, n >> 1 & 1, n >> 2};
        const Index3 node{(own.x >> 1) + d[0], (own.y >> 1) + d[1], (own.z >> 1) + d[2]};
        const Index3 on     = page_of(node);
        const int    octant = (on.x - (base.x >> 1)) | (on.y - (base.y >> 1)) << 1 | (on.z - (base.z >> 1)) << 2;
        if (parent[octant] < 0) { continue; }
        Real      share = 1;
        const int odd[] = {own.x & 1, own.y & 1, own.z & 1};
        for (int axis = 0; axis < 3; ++axis) { share *= odd[axis] == d[axis] ? Real(0.75) : Real(0.25); }
        const NodeEnd<Real> above =
            read_motion(motion + std::int64_t(parent[octant]) * motion_channels * page_cells + place_in_page(node));
        sum.velocity += share * above.velocity;
        sum.change += share * above.change;
    }
    return sum;
}

} // namespace tread::mpm
