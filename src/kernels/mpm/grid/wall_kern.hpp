#pragma once

#include "kernels/mpm/grid/grid.hpp"
#include "kernels/mpm/grid/levels.hpp"

// Wall conditions on the grid velocity. A quadratic spline on a wall's plane weights three nodes by 1/8, 6/8 and 1/8:
// fixing the node on the plane does not fix the sand there. Instead, the three nodes (outside, on the plane, inside)
// are constrained together: v_out = -v_in, v_on = 0, so that a linear profile is interpolated exactly and vanishes on
// the plane. Of all such velocities the one nearest to the free velocity in the metric of the lumped masses is used:
// v_in = (m_in v_in* - m_out v_out*) / (m_in + m_out), which is the result of constraint forces. Linear splines involve
// no node outside: the same rule then constrains the node on the plane alone.
namespace tread::mpm
{

/// Position of a node along one axis relative to the wall of that axis that may constrain it.
struct WallPlace
{
    int  end;    ///< 0 low, 1 high, -1 no wall
    int  depth;  ///< spacings into the domain: 1, 0, -1 ...
    bool paired; ///< constrained together with its mirror image; otherwise alone
};

/// Whether two walls are less than three spacings apart, where mirror images would be shared: nodes are then
/// constrained one by one. So are nodes more than a spacing beyond a wall, where sand rarely is.
TREAD_HD bool is_thin(const GridWalls& walls, int axis)
{
    return walls.rule[axis][0] != WallRule::open && walls.rule[axis][1] != WallRule::open && walls.last_node[axis] < 3;
}

TREAD_HD WallPlace wall_place(const GridWalls& walls, int axis, std::int32_t node)
{
    const std::int32_t last      = walls.last_node[axis];
    const bool         closed[2] = {walls.rule[axis][0] != WallRule::open, walls.rule[axis][1] != WallRule::open};
    const bool         thin      = is_thin(walls, axis);
    const int          reach     = thin ? 0 : 1;
    if (closed[0] && node <= reach) { return {0, node, !thin && node >= -1}; }
    if (closed[1] && last - node <= reach) { return {1, last - node, !thin && last - node >= -1}; }
    return {-1, 0, false};
}

TREAD_HD std::int32_t along(Index3 node, int axis) { return axis == 0 ? node.x : axis == 1 ? node.y : node.z; }

TREAD_HD Index3 beside(Index3 node, int axis, int steps)
{
    return {node.x + (axis == 0 ? steps : 0), node.y + (axis == 1 ? steps : 0), node.z + (axis == 2 ? steps : 0)};
}

/// How walls may constrain a node: with its mirror image, alone, or, by different walls, both.
struct Held
{
    bool paired = false;
    bool alone  = false;
};

TREAD_HD Held held_by(const GridWalls& walls, Index3 node)
{
    Held held;
    for (int axis = 0; axis < 3; ++axis)
    {
        const WallPlace place = wall_place(walls, axis, along(node, axis));
        held.paired           = held.paired || place.paired;
        held.alone            = held.alone || (place.end >= 0 && !place.paired);
    }
    return held;
}

/// Whether any wall may constrain a node of the page at `page`. Refined boxes do not touch walls.
TREAD_HD bool has_held_nodes(const GridWalls& walls, Index3 page)
{
    if (level_of(page) > 0) { return false; }
    for (int axis = 0; axis < 3; ++axis)
    {
        const std::int32_t first = along(page, axis) * page_edge;
        if (wall_place(walls, axis, first).end >= 0 || wall_place(walls, axis, first + page_edge - 1).end >= 0)
        {
            return true;
        }
    }
    return false;
}

/// Whether walls constrain nodes of the page at `page` together with others across an axis: the nodes on a wall's plane
/// and next to it.
TREAD_HD bool has_paired_nodes(const GridWalls& walls, Index3 page, int axis)
{
    if (is_thin(walls, axis)) { return false; }
    for (int end = 0; end < 2; ++end)
    {
        const int plane = (end == 0 ? 0 : walls.last_node[axis]) - along(page, axis) * page_edge;
        if (walls.rule[axis][end] != WallRule::open && plane >= -1 && plane <= page_edge) { return true; }
    }
    return false;
}

/// Returns the velocity components (bit c) that walls which pair the node may constrain.
TREAD_HD unsigned held_components(const GridWalls& walls, Index3 node)
{
    unsigned held = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const WallPlace place = wall_place(walls, axis, along(node, axis));
        if (!place.paired) { continue; }
        held |= walls.rule[axis][place.end] == WallRule::slip ? 1U << axis : 7U;
    }
    return held;
}

/// Nodes outside, on and inside a wall's plane. Missing nodes and nodes below the mass floor have zero mass.
template<class Real>
struct WallGroup
{
    Real       mass[3]     = {};
    Vec3<Real> velocity[3] = {Vec3<Real>::Zero(), Vec3<Real>::Zero(), Vec3<Real>::Zero()};
};

/// Computes the values that fully constrain one component of the group.
template<class Real>
TREAD_HD void held_component(const WallGroup<Real>& group, int component, Real* held)
{
    const Real mass = group.mass[0] + group.mass[2];
    held[2]         = mass > 0
                          ? (group.mass[2] * group.velocity[2][component] - group.mass[0] * group.velocity[0][component]) / mass
                          : Real(0);
    held[1]         = 0;
    held[0]         = -held[2];
}

/// Moves one component by `share` (0 to 1) towards its constrained value; returns the impulse of the wall, N s.
template<class Real>
TREAD_HD Real hold_component(WallGroup<Real>& group, int component, Real share)
{
    Real held[3], impulse = 0;
    held_component(group, component, held);
    for (int i = 0; i < 3; ++i)
    {
        const Real change = share * (held[i] - group.velocity[i][component]);
        impulse += group.mass[i] * change;
        group.velocity[i][component] += change;
    }
    return impulse;
}

template<class Real>
TREAD_HD double kinetic_energy(const WallGroup<Real>& group)
{
    double energy = 0;
    for (int i = 0; i < 3; ++i) { energy += 0.5 * double(group.mass[i]) * double(group.velocity[i].squaredNorm()); }
    return energy;
}

/// Applies Coulomb's law to the group: it sticks if the tangential impulse that this requires is at most `friction`
/// times the `normal` one (N s, of the wall on the sand); otherwise it slides with that limit. Returns the dissipated
/// energy, J.
template<class Real>
TREAD_HD double rub(WallGroup<Real>& group, int axis, Real friction, Real normal)
{
    const int  first = (axis + 1) % 3, second = (axis + 2) % 3;
    const auto before   = group;
    const Real along[2] = {hold_component(group, first, Real(1)), hold_component(group, second, Real(1))};
    const Real most     = friction * (normal > 0 ? normal : Real(0)),
               wanted   = std::sqrt(along[0] * along[0] + along[1] * along[1]);
    if (wanted > most)
    {
        group = before;
        hold_component(group, first, most / wanted);
        hold_component(group, second, most / wanted);
    }
    return kinetic_energy(before) - kinetic_energy(group);
}

/// Applies the wall at `end` of `axis` to one group. Returns the energy dissipated by friction, J.
template<class Real>
TREAD_HD double hold(const GridWalls& walls, int axis, int end, WallGroup<Real>& group)
{
    const WallRule rule    = walls.rule[axis][end];
    const Real     inwards = end == 0 ? Real(1) : Real(-1);
    if (rule != WallRule::fixed && inwards * group.velocity[1][axis] >= 0) { return 0; }
    if (rule == WallRule::fixed || rule == WallRule::rough)
    {
        for (int c = 0; c < 3; ++c) { hold_component(group, c, Real(1)); }
        return 0;
    }
    const Real normal = inwards * hold_component(group, axis, Real(1));
    return rule == WallRule::frictional ? rub(group, axis, static_cast<Real>(walls.friction), normal) : 0;
}

/// Separates friction from the loss of walls, because the end of the node's step adds the total loss.
template<class Sum>
TREAD_HD void account_friction(double friction, Sum* sums)
{
    sums[grid_friction] += Sum(friction);
    sums[grid_wall_loss] -= Sum(friction);
}

/// Applies walls to a node that is constrained alone. Adds the dissipation of friction to `sums`.
template<class Real, class Sum>
TREAD_HD Vec3<Real> hold_alone(const GridWalls& walls, Index3 node, Real mass, const Vec3<Real>& velocity, Sum* sums)
{
    WallGroup<Real> group;
    group.mass[1]     = mass;
    group.velocity[1] = velocity;
    for (int axis = 0; axis < 3; ++axis)
    {
        const WallPlace place = wall_place(walls, axis, along(node, axis));
        if (place.end < 0 || place.paired) { continue; }
        account_friction(hold(walls, axis, place.end, group), sums);
    }
    return group.velocity[1];
}

} // namespace tread::mpm
