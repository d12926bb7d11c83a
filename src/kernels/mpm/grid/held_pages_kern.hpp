#pragma once

#include "kernels/mpm/grid/grid_kern.hpp"
#include "kernels/mpm/grid/held_pages.hpp"
#include "kernels/mpm/transfers/gather.hpp"

namespace tread::mpm
{

/// Whether the node at a place of a held page is in a stencil of one of the surrounding sleeping pages.
TREAD_HD bool is_held(unsigned sleeping, int place)
{
    const int x = place & 3, y = place >> 2 & 3, z = place >> 4;
    for (int octant = 0; octant < octants; ++octant)
    {
        const bool reached = x < octant_edge(octant, 0) && y < octant_edge(octant, 1) && z < octant_edge(octant, 2);
        if (reached && (sleeping >> octant & 1U) != 0) { return true; }
    }
    return false;
}

/// Stops a node after forces and walls have acted, and adds the difference to the sums. `channels`: result of
/// sum_tiles or read_total. All forces on a node do work on the mean of its velocities before and after the step, and
/// the latter is now 0.
template<class Real, class Sum>
TREAD_HD void stop_node(const GridStep<Real>& step, Index3 node, const Real* channels, Real* motion, Sum* sums)
{
    const NodeStep<Real> begun = begin_node(step, held_components(step.walls, node), channels);
    if (begun.mass == 0) { return; }
    const Vec3<Real> after   = read_motion(motion).velocity;
    const Vec3<Real> weight  = begun.mass * step.gravity;
    const Vec3<Real> by_wall = begun.mass * (after - begun.moved);
    sums[grid_kinetic_after] -= Sum(Real(0.5) * begun.mass * after.squaredNorm());
    sums[grid_gravity_power] -= Sum(weight.dot(after));
    sums[grid_gravity_work] -= Sum(Real(0.5) * step.dt * weight.dot(after));
    sums[grid_net_force] += Sum(begun.mass * (begun.before.norm() - (after - begun.before).norm()) / step.dt);
    sums[grid_wall_loss] +=
        Sum(Real(0.5) * (begun.mass * begun.moved.dot(begun.before) + by_wall.dot(begun.before + after)));
    for (int c = 0; c < 3; ++c) { sums[grid_wall_impulse + c] -= Sum(begun.mass * after[c]); }
    write_motion({Vec3<Real>(Vec3<Real>::Zero()), Vec3<Real>(-begun.before)}, motion);
}

/// Stops one node of held page `number`, if it is held.
template<class Real, class Sum>
TREAD_HD void hold_place(const PagesView& pages, const HeldPagesView& held, const SharedPagesView<Real>& shared_pages,
                         std::int64_t number, int place, const Real* tiles, const GridStep<Real>& step, Real* motion,
                         Sum* sums)
{
    if (!is_held(held.octants[number], place)) { return; }
    const std::int64_t page   = held.page[number];
    const std::int32_t shared = shared_pages.number(page);
    Real               channels[node_channels];
    if (shared >= 0) { read_total(shared_pages, shared, place, channels); }
    else
    {
        std::int32_t tile_pages[octants];
        for (int octant = 0; octant < octants; ++octant) { tile_pages[octant] = tile_page(pages, page, octant); }
        sum_tiles(tile_pages, tiles, place, channels);
    }
    const Index3 node = node_at(page_coordinates(pages.node_page_key[page]), place);
    stop_node(step, node, channels, motion + page * motion_channels * page_cells + place, sums);
}

struct KeepLargestSpeed
{
    const double* peaks;
    double*       largest;

    TREAD_HD void operator()(std::int64_t page) const
    {
        largest[page] = std::fmax(largest[page], peaks[page * point_peaks + peak_speed_squared]);
    }
};

} // namespace tread::mpm
