#pragma once

#include "kernels/local_damping_kern.hpp"
#include "kernels/mpm/grid/grid.hpp"
#include "kernels/mpm/grid/wall_kern.hpp"
#include "kernels/mpm/transfers/stencil_kern.hpp"

namespace tread::mpm
{

/// Returns the point page whose tile contributes to a node page from an octant, or -1 if there is none or it has no
/// points.
TREAD_HD std::int32_t tile_page(const PagesView& pages, std::int64_t node_page, int octant)
{
    const std::int32_t page = pages.point_page_of[octants * node_page + octant];
    return page >= 0 && pages.first_point[page] < pages.first_point[page + 1] ? page : -1;
}

/// Sums the tiles that contribute to a node (at most eight), lowest octant first. `tile_pages`: by octant.
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
        for (int c = 0; c < node_channels; ++c) { total[c] += tile[c * octant_nodes(octant)]; }
    }
}

/// Reads the node's total in shared page `number`.
template<class Real>
TREAD_HD void read_total(const SharedPagesView<Real>& shared_pages, std::int32_t number, int place, Real* total)
{
    const Real* from = shared_pages.total + std::int64_t(number) * node_page_values + place;
    for (int c = 0; c < node_channels; ++c) { total[c] = from[c * page_cells]; }
}

/// State of a node before wall conditions.
template<class Real>
struct NodeStep
{
    Real       mass    = 0; ///< kg; 0 if below the mass floor
    Vec3<Real> before  = Vec3<Real>::Zero();
    Vec3<Real> force   = Vec3<Real>::Zero(); ///< N, weight and forces from the points
    Vec3<Real> damping = Vec3<Real>::Zero(); ///< N
    Vec3<Real> moved   = Vec3<Real>::Zero(); ///< m/s, velocity after all forces except those of walls
};

/// Result of a step at a node; zero at a node without sand.
template<class Real>
struct NodeEnd
{
    Vec3<Real> velocity = Vec3<Real>::Zero(); ///< m/s, after the step
    Vec3<Real> change   = Vec3<Real>::Zero(); ///< m/s, in the step
};

/// Starts a node's step. `channels`: result of sum_tiles. Local damping is proportional to the unbalanced force, but
/// excludes the components in the set `held` (bit c): the force on a node next to a wall is balanced by its mirror
/// image and the wall, not by the node itself; with damping it would never come to rest.
template<class Real>
TREAD_HD NodeStep<Real> begin_node(const GridStep<Real>& step, unsigned held, const Real* channels)
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
            if ((held >> c & 1U) != 0) { continue; }
            node.damping[c] = local_damping(step.damping, node.force[c], node.before[c]);
        }
    }
    node.moved = node.before + (step.dt * inverse) * (node.force + node.damping);
    return node;
}

/// Adds the work and impulse of the forces. `after`: m/s, correct in all damped components.
template<class Real, class Sum>
TREAD_HD void account_forces(const GridStep<Real>& step, const NodeStep<Real>& node, const Vec3<Real>& after, Sum* sums)
{
    sums[grid_kinetic_before] += Sum(Real(0.5) * node.mass * node.before.squaredNorm());
    sums[grid_power_before] += Sum(node.force.dot(node.before));
    if (step.damping > 0)
    {
        sums[grid_damped] -= Sum(Real(0.5) * step.dt * node.damping.dot(node.before + after));
        for (int c = 0; c < 3; ++c) { sums[grid_damping_impulse + c] += Sum(step.dt * node.damping[c]); }
    }
}

/// Completes a node's step: adds the energies after it.
template<class Real, class Sum>
TREAD_HD NodeEnd<Real> finish_node(const GridStep<Real>& step, Real mass, const Vec3<Real>& before,
                                   const Vec3<Real>& after, Sum* sums)
{
    const Vec3<Real> change = after - before;
    const Vec3<Real> weight = mass * step.gravity;
    sums[grid_kinetic_after] += Sum(Real(0.5) * mass * after.squaredNorm());
    sums[grid_gravity_power] += Sum(weight.dot(after));
    sums[grid_gravity_work] += Sum(Real(0.5) * step.dt * weight.dot(before + after));
    sums[grid_net_force] += Sum(mass * change.norm() / step.dt);
    return {after, change};
}

/// Adds the energy and impulse of walls at a node whose velocity without walls is `moved`.
template<class Real, class Sum>
TREAD_HD void account_walls(Real mass, const Vec3<Real>& before, const Vec3<Real>& moved, const Vec3<Real>& after,
                            Sum* sums)
{
    const Vec3<Real> impulse = mass * (after - moved);
    sums[grid_wall_loss] -= Sum(Real(0.5) * impulse.dot(before + after));
    for (int c = 0; c < 3; ++c) { sums[grid_wall_impulse + c] += Sum(impulse[c]); }
}

/// Updates a node that no wall may constrain. `channels`: result of sum_tiles.
template<class Real, class Sum>
TREAD_HD NodeEnd<Real> update_free_node(const GridStep<Real>& step, const Real* channels, Sum* sums)
{
    const NodeStep<Real> begun = begin_node(step, 0, channels);
    if (begun.mass == 0) { return {}; }
    account_forces(step, begun, begun.moved, sums);
    return finish_node(step, begun.mass, begun.before, begun.moved, sums);
}

/// Updates a node on a wall page. For a node that walls constrain together with others it does only the first part:
/// `wall_node` is then its mass and present velocity, and the result, for finish_held, contains its velocities without
/// walls and before the step.
template<class Real, class Sum>
TREAD_HD NodeEnd<Real> update_node(const GridStep<Real>& step, Index3 node, const Real* channels,
                                   WallNode<Real>& wall_node, Sum* sums)
{
    wall_node                  = {};
    const NodeStep<Real> begun = begin_node(step, held_components(step.walls, node), channels);
    if (begun.mass == 0) { return {}; }
    const Held       held  = held_by(step.walls, node);
    const Vec3<Real> after = held.alone ? hold_alone(step.walls, node, begun.mass, begun.moved, sums) : begun.moved;
    account_forces(step, begun, after, sums);
    if (held.paired)
    {
        wall_node = {{begun.mass, after[0], after[1], after[2]}};
        return {begun.moved, begun.before};
    }
    account_walls(begun.mass, begun.before, begun.moved, after, sums);
    return finish_node(step, begun.mass, begun.before, after, sums);
}

/// Completes the step of a node that walls constrain to `after` (m/s). `begun`: result of update_node.
template<class Real, class Sum>
TREAD_HD NodeEnd<Real> finish_held(const GridStep<Real>& step, Real mass, const NodeEnd<Real>& begun,
                                   const Vec3<Real>& after, Sum* sums)
{
    const Vec3<Real>& moved  = begun.velocity;
    const Vec3<Real>& before = begun.change;
    account_walls(mass, before, moved, after, sums);
    return finish_node(step, mass, before, after, sums);
}

template<class Real>
TREAD_HD void write_motion(const NodeEnd<Real>& node, Real* motion)
{
    for (int c = 0; c < 3; ++c)
    {
        motion[c * page_cells]       = node.velocity[c];
        motion[(3 + c) * page_cells] = node.change[c];
    }
}

template<class Real>
TREAD_HD NodeEnd<Real> read_motion(const Real* motion)
{
    NodeEnd<Real> node;
    for (int c = 0; c < 3; ++c)
    {
        node.velocity[c] = motion[c * page_cells];
        node.change[c]   = motion[(3 + c) * page_cells];
    }
    return node;
}

} // namespace tread::mpm
