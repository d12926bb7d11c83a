#pragma once

#include "backend/array.hpp"
#include "kernels/mpm/pages.hpp"
#include "kernels/mpm/scatter_kern.hpp"
#include "kernels/mpm/tally.hpp"

namespace tread::mpm
{

/// What a wall of the domain does to the grid's velocity at its nodes and beyond.
enum class WallRule : std::int32_t
{
    open,
    slip,      ///< no velocity into the wall; sand may leave it
    fixed,     ///< no velocity
    frictional ///< as slip, and Coulomb's friction along the wall
};

/// [axis][0 = low side, 1 = high side].
struct GridWalls
{
    WallRule     rule[3][2];
    std::int32_t last_node[3]; ///< node on the high wall; the low wall's is 0
    double       friction;     ///< coefficient of the frictional walls
};

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

/// Per page, fp64: what the grid did to energy and momentum in a step.
enum GridSum : int
{
    grid_kinetic_before,                          ///< J, after P2G
    grid_kinetic_after,                           ///< J, before G2P
    grid_power_before,                            ///< W, of all forces but damping on the velocity after P2G
    grid_gravity_power,                           ///< W, of the weight on the velocity before G2P
    grid_damped,                                  ///< J, taken by local damping
    grid_wall_loss,                               ///< J, taken by walls, friction apart
    grid_friction,                                ///< J, taken by the friction of walls
    grid_gravity_work,                            ///< J, done by gravity
    grid_net_force,                               ///< N, sum of |m dv/dt|: what is out of balance
    grid_wall_impulse,                            ///< N s (3)
    grid_damping_impulse = grid_wall_impulse + 3, ///< N s (3)
    grid_sums            = grid_damping_impulse + 3
};

/// Sums the tiles that reach each node, in a fixed order, and updates its velocity (Eq. 2 of the paper, lumped mass):
/// motion[node page][channel][place]; books the step in the page's tally of GridSum. Nodes within one spacing of a wall
/// are left for update_walls, which must follow where any wall is not open.
template<class Real>
void update_grid(const Cpu&, const PagesView& pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                 double* tallies);
template<class Real>
void update_grid(const Gpu&, const PagesView& pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                 double* tallies);

/// Node pages by number, of `count`.
struct PageList
{
    const std::int32_t* page;
    std::int64_t        count;
};

/// Finishes the nodes within one spacing of a wall: the splines' velocity vanishes on the wall's plane for every linear
/// profile, whatever the wall holds (wall_kern.hpp). `wall_pages`: of list_wall_pages. Books more of the step in the
/// tallies of those pages.
template<class Real>
void update_walls(const Cpu&, const PagesView& pages, const PageList& wall_pages, const Real* tiles,
                  const GridStep<Real>& step, Real* motion, double* tallies);
template<class Real>
void update_walls(const Gpu&, const PagesView& pages, const PageList& wall_pages, const Real* tiles,
                  const GridStep<Real>& step, Real* motion, double* tallies);

/// Whether any wall across an axis holds anything.
inline bool has_walls(const GridWalls& walls, int axis)
{
    return walls.rule[axis][0] != WallRule::open || walls.rule[axis][1] != WallRule::open;
}

/// Whether any wall holds anything.
inline bool has_walls(const GridWalls& walls)
{
    return has_walls(walls, 0) || has_walls(walls, 1) || has_walls(walls, 2);
}

} // namespace tread::mpm
