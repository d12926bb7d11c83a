#pragma once

#include "backend/array.hpp"
#include "kernels/mpm/grid/walls.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/pages/shared_pages.hpp"
#include "kernels/mpm/tally.hpp"
#include "kernels/mpm/transfers/scatter_kern.hpp"

namespace tread::mpm
{

template<class Real>
struct GridStep
{
    Real       dt;         ///< s
    Vec3<Real> gravity;    ///< m/s2
    Real       damping;    ///< local (Cundall) damping coefficient, 0 outside settling phases
    Real       mass_floor; ///< kg; lighter nodes stay at rest
    GridWalls  walls;
};

/// Number of components of a node's result: velocity after the step (3) and its change in the step (3).
constexpr int motion_channels = 6;

/// Sums per page, fp64: energy and momentum changes by the grid in a step. First all nodes, then local damping, then
/// walls.
enum GridSum : int
{
    grid_kinetic_before,                       ///< J, after P2G
    grid_kinetic_after,                        ///< J, before G2P
    grid_power_before,                         ///< W, power of all forces except damping on the velocity after P2G
    grid_gravity_power,                        ///< W, power of the weight on the velocity before G2P
    grid_gravity_work,                         ///< J, work of gravity
    grid_net_force,                            ///< N, sum of |m dv/dt|: unbalanced force
    grid_damped,                               ///< J, dissipated by local damping
    grid_damping_impulse,                      ///< N s (3)
    grid_wall_loss = grid_damping_impulse + 3, ///< J, dissipated by walls without their friction
    grid_friction,                             ///< J, dissipated by the friction of walls
    grid_wall_impulse,                         ///< N s (3)
    grid_sums = grid_wall_impulse + 3
};

/// Sums the tiles that contribute to each node, in a fixed order, or takes the totals of shared pages. Updates the
/// node's velocity (Eq. 2 of the paper, lumped mass): motion[node page][channel][place], and adds the step to the
/// page's tally of GridSum. Nodes that walls constrain together with others are left to update_walls, which must follow
/// if there are wall pages.
template<class Exec, class Real>
void update_grid(const Exec&, const PagesView& pages, const WallPagesView<Real>& wall_pages,
                 const SharedPagesView<Real>& shared_pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                 double* tallies);

/// Completes the nodes within one spacing of a wall: the splines' velocity vanishes on the wall's plane for every
/// linear profile, whatever components the wall constrains (wall_kern.hpp). Adds to the tallies of the wall pages.
template<class Exec, class Real>
void update_walls(const Exec&, const PagesView& pages, const WallPagesView<Real>& wall_pages,
                  const GridStep<Real>& step, Real* motion, double* tallies);

} // namespace tread::mpm
