#pragma once

#include "kernels/local_damping_kern.hpp"
#include "kernels/mpm/grid.hpp"
#include "kernels/mpm/stencil_kern.hpp"
#include "kernels/mpm/wall_kern.hpp"

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

/// A node before walls have touched it.
template<class Real>
struct NodeStep
{
    Real       mass    = 0; ///< kg; 0 if it is too light to move
    Vec3<Real> before  = Vec3<Real>::Zero();
    Vec3<Real> force   = Vec3<Real>::Zero(); ///< N, weight and what points bring
    Vec3<Real> damping = Vec3<Real>::Zero(); ///< N
    Vec3<Real> moved   = Vec3<Real>::Zero(); ///< m/s, by all forces but those of walls
};

/// `channels`: what sum_tiles gave. Local damping is a share of the force that is out of balance. What acts on a node
/// beside a wall is balanced by its mirror image and the wall, not by the node: damped, it would never come to rest.
template<class Real>
TREAD_HD NodeStep<Real> begin_node(const GridStep<Real>& step, Index3 at, const Real* channels)
{
    NodeStep<Real> node;
    if (channels[0] <= step.mass_floor) { return node; }
    node.mass          = channels[0];
    const Real inverse = Real(1) / node.mass;
    node.before        = inverse * Vec3<Real>(channels[1], channels[2], channels[3]);
    node.force         = Vec3<Real>(channels[4], channels[5], channels[6]) + node.mass * step.gravity;
    if (step.damping > 0)
    {
        for (int c = 0; c < 3; ++c)
        {
            if (may_hold(step.walls, at, c)) { continue; }
            node.damping[c] = local_damping(step.damping, node.force[c], node.before[c]);
        }
    }
    node.moved = node.before + (step.dt * inverse) * (node.force + node.damping);
    return node;
}

/// Writes velocity and change to motion[c * 64], adds to `sums` what every node does.
template<class Real>
TREAD_HD void finish_free_node(const GridStep<Real>& step, const NodeStep<Real>& node, const Vec3<Real>& after,
                               Real* motion, double* sums)
{
    const Vec3<Real> change = after - node.before, middle = Real(0.5) * (node.before + after);
    sums[grid_kinetic_before] += double(Real(0.5) * node.mass * node.before.squaredNorm());
    sums[grid_kinetic_after] += double(Real(0.5) * node.mass * after.squaredNorm());
    sums[grid_power_before] += double(node.force.dot(node.before));
    sums[grid_gravity_power] += double(node.mass * step.gravity.dot(after));
    sums[grid_gravity_work] += double(node.mass * step.dt * step.gravity.dot(middle));
    sums[grid_net_force] += double(node.mass * change.norm() / step.dt);
    if (step.damping > 0)
    {
        sums[grid_damped] -= double(step.dt * node.damping.dot(middle));
        for (int c = 0; c < 3; ++c) { sums[grid_damping_impulse + c] += double(step.dt * node.damping[c]); }
    }
    for (int c = 0; c < 3; ++c)
    {
        motion[c * page_cells]       = after[c];
        motion[(3 + c) * page_cells] = change[c];
    }
}

/// The same, and what walls did to the node.
template<class Real>
TREAD_HD void finish_node(const GridStep<Real>& step, const NodeStep<Real>& node, const Vec3<Real>& after, Real* motion,
                          double* sums)
{
    finish_free_node(step, node, after, motion, sums);
    const Vec3<Real> middle = Real(0.5) * (node.before + after);
    const double     m      = double(node.mass);
    sums[grid_wall_loss] -= m * double((after - node.moved).dot(middle));
    for (int c = 0; c < 3; ++c) { sums[grid_wall_impulse + c] += m * double(after[c] - node.moved[c]); }
}

template<class Real>
TREAD_HD void write_velocity(const Vec3<Real>& velocity, Real* motion)
{
    for (int c = 0; c < 3; ++c) { motion[c * page_cells] = velocity[c]; }
}

template<class Real>
TREAD_HD Vec3<Real> read_velocity(const Real* motion)
{
    return {motion[0], motion[page_cells], motion[2 * page_cells]};
}

/// Of a node that others finish, the mass stands where its change will.
template<class Real>
TREAD_HD Real& unfinished_mass(Real* motion)
{
    return motion[3 * page_cells];
}

/// A node that the sand has left stands still.
template<class Real>
TREAD_HD void clear_node(Real* motion)
{
    for (int c = 0; c < motion_channels; ++c) { motion[c * page_cells] = 0; }
}

/// One node's step where no wall may hold it. `channels`: what sum_tiles gave.
template<class Real>
TREAD_HD void update_free_node(const GridStep<Real>& step, Index3 node, const Real* channels, Real* motion,
                               double* sums)
{
    const NodeStep<Real> begun = begin_node(step, node, channels);
    if (begun.mass == 0) { clear_node(motion); }
    else { finish_free_node(step, begun, begun.moved, motion, sums); }
}

/// One node's step, or, of a node that walls hold together with others, its first part.
template<class Real>
TREAD_HD void update_node(const GridStep<Real>& step, Index3 node, const Real* channels, Real* motion, double* sums)
{
    const NodeStep<Real> begun = begin_node(step, node, channels);
    if (begun.mass == 0)
    {
        clear_node(motion);
        return;
    }
    const Held       held  = held_by(step.walls, node);
    const Vec3<Real> after = held.alone ? hold_alone(step.walls, node, begun.mass, begun.moved, sums) : begun.moved;
    if (!held.paired)
    {
        finish_node(step, begun, after, motion, sums);
        return;
    }
    write_velocity(after, motion);
    unfinished_mass(motion) = begun.mass;
}

} // namespace tread::mpm
