#pragma once

#include "kernels/local_damping_kern.hpp"
#include "kernels/mpm/grid.hpp"
#include "kernels/mpm/stencil_kern.hpp"

namespace tread::mpm
{

/// The point page whose tile reaches a node page from an octant, or -1 where there is none or no point in it.
TREAD_HD std::int32_t tile_page(const PagesView& pages, std::int64_t node_page, int octant)
{
    const std::int32_t page = pages.point_page_of[octants * node_page + octant];
    return page >= 0 && pages.first_point[page] < pages.first_point[page + 1] ? page : -1;
}

/// Sum of the up to eight tiles that reach a node, lowest octant first. `tile_pages`: by octant.
template<class Real>
TREAD_HD void sum_tiles(const std::int32_t* tile_pages, const Real* tiles, int place, Real* total)
{
    const int x = place & 3, y = place >> 2 & 3, z = place >> 4;
    for (int c = 0; c < node_channels; ++c) { total[c] = 0; }
    for (int octant = 0; octant < octants; ++octant)
    {
        if (x >= octant_edge(octant, 0) || y >= octant_edge(octant, 1) || z >= octant_edge(octant, 2)) { continue; }
        if (tile_pages[octant] < 0) { continue; }
        const Real* tile = tiles + std::int64_t(tile_pages[octant]) * node_channels * tile_nodes +
                           octant_start(octant) + x + octant_edge(octant, 0) * (y + octant_edge(octant, 1) * z);
        for (int c = 0; c < node_channels; ++c) { total[c] += tile[c * tile_nodes]; }
    }
}

template<class Real>
TREAD_HD Vec3<Real> apply_walls(const GridWalls& walls, Index3 node, Vec3<Real> velocity)
{
    const std::int32_t at[3] = {node.x, node.y, node.z};
    for (int axis = 0; axis < 3; ++axis)
    {
        const bool low = at[axis] <= 0, high = at[axis] >= walls.last_node[axis];
        if ((low && walls.rule[axis][0] == WallRule::fixed) || (high && walls.rule[axis][1] == WallRule::fixed))
        {
            return Vec3<Real>::Zero();
        }
        if (low && walls.rule[axis][0] == WallRule::slip && velocity[axis] < 0) { velocity[axis] = 0; }
        if (high && walls.rule[axis][1] == WallRule::slip && velocity[axis] > 0) { velocity[axis] = 0; }
    }
    return velocity;
}

/// One node's step. `channels`: what sum_tiles gave. Writes velocity and change to motion[c * 64], adds to `sums`.
template<class Real>
TREAD_HD void update_node(const GridStep<Real>& step, Index3 node, const Real* channels, Real* motion, double* sums)
{
    Vec3<Real> after = Vec3<Real>::Zero(), change = Vec3<Real>::Zero();
    const Real mass = channels[0];
    if (mass > step.mass_floor)
    {
        const Vec3<Real> before  = Vec3<Real>(channels[1], channels[2], channels[3]) / mass;
        const Vec3<Real> force   = Vec3<Real>(channels[4], channels[5], channels[6]) + mass * step.gravity;
        Vec3<Real>       damping = Vec3<Real>::Zero();
        if (step.damping > 0)
        {
            for (int c = 0; c < 3; ++c) { damping[c] = local_damping(step.damping, force[c], before[c]); }
        }
        const Vec3<Real> moved = before + (step.dt / mass) * (force + damping);
        after                  = apply_walls(step.walls, node, moved);
        change                 = after - before;

        const double m = double(mass);
        sums[grid_kinetic_before] += 0.5 * m * double(before.squaredNorm());
        sums[grid_kinetic_after] += 0.5 * m * double(after.squaredNorm());
        sums[grid_power_before] += double(force.dot(before));
        sums[grid_gravity_power] += m * double(step.gravity.dot(after));
        const Vec3<Real> middle = Real(0.5) * (before + after);
        sums[grid_damped] -= double(step.dt * damping.dot(middle));
        sums[grid_wall_loss] -= m * double((after - moved).dot(middle));
        sums[grid_net_force] += double(mass * change.norm() / step.dt);
        for (int c = 0; c < 3; ++c)
        {
            sums[grid_wall_impulse + c] += m * double(after[c] - moved[c]);
            sums[grid_damping_impulse + c] += double(step.dt * damping[c]);
        }
    }
    for (int c = 0; c < 3; ++c)
    {
        motion[c * page_cells]       = after[c];
        motion[(3 + c) * page_cells] = change[c];
    }
}

} // namespace tread::mpm
