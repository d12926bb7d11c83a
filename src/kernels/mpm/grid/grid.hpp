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
    Real       damping;    ///< local (Cundall) damping, 0 outside settling phases
    Real       mass_floor; ///< kg; lighter nodes stand still
    GridWalls  walls;
};

/// Components of a node's result: velocity after the step (3), its change in the step (3).
constexpr int motion_channels = 6;

/// Per page, fp64: what the grid did to energy and momentum in a step. First what every node does, then local damping,
/// then walls.
enum GridSum : int
{
    grid_kinetic_before,                       ///< J, after P2G
    grid_kinetic_after,                        ///< J, before G2P
    grid_power_before,                         ///< W, of all forces but damping on the velocity after P2G
    grid_gravity_power,                        ///< W, of the weight on the velocity before G2P
    grid_gravity_work,                         ///< J, done by gravity
    grid_net_force,                            ///< N, sum of |m dv/dt|: what is out of balance
    grid_damped,                               ///< J, taken by local damping
    grid_damping_impulse,                      ///< N s (3)
    grid_wall_loss = grid_damping_impulse + 3, ///< J, taken by walls, friction apart
    grid_friction,                             ///< J, taken by the friction of walls
    grid_wall_impulse,                         ///< N s (3)
    grid_sums = grid_wall_impulse + 3
};

/// Sums the tiles that reach each node, in a fixed order, or takes the totals of shared pages, and updates its velocity
/// (Eq. 2 of the paper, lumped mass): motion[node page][channel][place]; books the step in the page's tally of GridSum.
/// Nodes that walls hold together with others are left for update_walls, which must follow where there are wall pages.
template<class Real>
void update_grid(const Cpu&, const PagesView& pages, const WallPagesView<Real>& wall_pages,
                 const SharedPagesView<Real>& shared_pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                 double* tallies);
template<class Real>
void update_grid(const Gpu&, const PagesView& pages, const WallPagesView<Real>& wall_pages,
                 const SharedPagesView<Real>& shared_pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                 double* tallies);

/// Finishes the nodes within one spacing of a wall: the splines' velocity vanishes on the wall's plane for every linear
/// profile, whatever the wall holds (wall_kern.hpp). Books more of the step in the tallies of the wall pages.
template<class Real>
void update_walls(const Cpu&, const PagesView& pages, const WallPagesView<Real>& wall_pages, const GridStep<Real>& step,
                  Real* motion, double* tallies);
template<class Real>
void update_walls(const Gpu&, const PagesView& pages, const WallPagesView<Real>& wall_pages, const GridStep<Real>& step,
                  Real* motion, double* tallies);

} // namespace tread::mpm
