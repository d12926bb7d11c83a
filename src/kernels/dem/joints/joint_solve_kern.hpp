#pragma once

#include <cmath>

#include "kernels/dem/joints/joint_rows.hpp"
#include "kernels/dem/motion/prescribed_kern.hpp"

// Solves the rows of all joints for their impulses: a sparse symmetric system, as L D L^T in the order of a plan
// (elimination.hpp). Impulses with bounds are found by active sets: those over a bound are held there, and the rest is
// solved again. A team of lanes works together; lanes are in groups that share one item.
namespace tread::dem::joint_solve
{

/// Pivots below this share of a row's diagonal mean that the row depends on rows before it.
inline constexpr double least_pivot = 1e-9;

/// Rows that yield less than this share of what their bodies without locks would are held: their impulses are not
/// determined.
inline constexpr double least_yield = 1e-12;

/// Largest number of solves in a substep. The states are kept, so that later substeps go on where this one stopped.
inline constexpr int most_rounds = 8;

/// Share of a row's target by which it may miss it at a bound, against rounding.
inline constexpr double bound_slack = 1e-9;

/// Calls f(item) for the items of list k, which the lanes share.
template<class T, class Lanes, class F>
TREAD_HD void for_each_of(const ListsView<T>& lists, std::int64_t k, const Lanes& lanes, F f)
{
    for (std::int64_t i = lists.first[k] + lanes.lane(); i < lists.first[k + 1]; i += lanes.lanes())
    {
        f(lists.item[i]);
    }
}

/// Inverse of the inertia for torques in directions that are not locked.
TREAD_HD Mat3<double> response_of(const Mat3<double>& rotation, const Mat3<double>& inverse_inertia,
                                  const Mat3<double>& inertia, std::uint32_t locked)
{
    if ((locked & locked_rotation) == 0) { return rotation * inverse_inertia * rotation.transpose(); }
    if ((locked & locked_rotation) == locked_rotation) { return Mat3<double>::Zero(); }
    Mat3<double> matrix = rotation * inertia * rotation.transpose();
    for (int c = 0; c < 3; ++c)
    {
        if (!is_locked(locked, lock_roll, c)) { continue; }
        matrix.row(c) = Vec3<double>::Unit(c).transpose();
        matrix.col(c) = Vec3<double>::Unit(c);
    }
    Mat3<double> response = matrix.inverse();
    for (int c = 0; c < 3; ++c)
    {
        if (!is_locked(locked, lock_roll, c)) { continue; }
        response.row(c).setZero();
        response.col(c).setZero();
    }
    return response;
}

/// Velocity of a body after a substep of dt (s) without joints, as integrate_body finds it without damping.
TREAD_HD JointLink free_motion(const BodiesView& bodies, std::int64_t b, const ContactWrench& contact,
                               const Vec3<double>& gravity, double dt)
{
    const std::uint32_t locked  = bodies.locked[b];
    const Mat3<double>  inertia = full(bodies.inertia[b]), inverse = inertia.inverse();
    const Quat          start    = bodies.orientation[b];
    const Mat3<double>  rotation = start.toRotationMatrix();
    const Vec3<double>  before   = bodies.angular_velocity[b];
    const Vec3<double>  momentum = rotation * (inertia * (rotation.transpose() * before)) + dt * contact.torque;
    const Vec3<double>  kicked   = angular_velocity_of(rotation, inertia, inverse, momentum, before, locked);
    const Quat          half     = rotation_by(0.5 * dt * kicked) * start;

    JointLink link;
    link.velocity = bodies.velocity[b];
    link.mobility = Mat3<double>::Zero();
    for (int c = 0; c < 3; ++c)
    {
        if (is_locked(locked, lock_x, c)) { continue; }
        link.mobility(c, c) = 1 / bodies.mass[b];
        link.velocity[c] += dt * link.mobility(c, c) * (contact.force[c] + bodies.mass[b] * gravity[c]);
    }
    link.angular_velocity = angular_velocity_of(half.toRotationMatrix(), inertia, inverse, momentum, before, locked);
    link.response         = response_of(rotation, inverse, inertia, locked);
    link.inverse_mass     = 1 / bodies.mass[b];
    link.inverse_inertia  = inverse.trace();
    return link;
}

/// The same of a body with a prescribed motion, as integrate_prescribed finds it. A held direction yields to no joint.
/// Friction of the axle is that without the joints.
TREAD_HD JointLink prescribed_motion(const BodiesView& bodies, std::int64_t b, const Prescribed& motion,
                                     const ContactWrench& contact, const Vec3<double>& gravity, double dt)
{
    const double        mass    = bodies.mass[b];
    const Mat3<double>  inertia = full(bodies.inertia[b]), inverse = inertia.inverse();
    const Quat          start    = bodies.orientation[b];
    const Mat3<double>  rotation = start.toRotationMatrix();
    const HeldSpin      first    = held_spin(motion, rotation);
    const Vec3<double>& before   = bodies.angular_velocity[b];
    const Vec3<double>  momentum = kick_of(motion, first, rotation, inertia, before, contact.torque, dt).momentum;
    const Vec3<double>  kicked   = angular_velocity_held(first, rotation, inverse, momentum);
    const Mat3<double>  half     = (rotation_by(0.5 * dt * kicked) * start).toRotationMatrix();

    JointLink link;
    link.velocity =
        velocity_after(motion, bodies.position[b][2], bodies.velocity[b], contact.force + mass * gravity, mass, dt);
    link.angular_velocity = angular_velocity_held(held_spin(motion, half), half, inverse, momentum);
    link.mobility         = mobility_of(motion, mass, dt);
    link.response         = response_held(first, rotation, inverse);
    link.inverse_mass     = 1 / mass;
    link.inverse_inertia  = inverse.trace();
    return link;
}

/// Makes a row that yields to no impulse.
TREAD_HD void hold(JointRow& row)
{
    row.diagonal = 0;
    for (int s = 0; s < row.sides; ++s)
    {
        row.linear_response[s].setZero();
        row.angular_response[s].setZero();
    }
}

/// Computes how the bodies of a row yield to its impulse.
TREAD_HD void respond(const JointsView& joints, JointRow& row)
{
    double unlocked = 0;
    row.diagonal    = 0;
    for (int s = 0; s < row.sides; ++s)
    {
        const JointLink& link   = joints.link[row.link[s]];
        row.linear_response[s]  = link.mobility * row.linear[s];
        row.angular_response[s] = link.response * row.angular[s];
        row.diagonal += row.linear[s].dot(row.linear_response[s]) + row.angular[s].dot(row.angular_response[s]);
        unlocked +=
            link.inverse_mass * row.linear[s].squaredNorm() + link.inverse_inertia * row.angular[s].squaredNorm();
    }
    if (row.diagonal <= least_yield * unlocked) { hold(row); }
    row.softness += row.relative_softness * row.diagonal;
    row.diagonal += row.softness;
}

TREAD_HD double rate_of(const JointRow& row, const JointLink* links)
{
    double rate = 0;
    for (int s = 0; s < row.sides; ++s)
    {
        const JointLink& link = links[row.link[s]];
        rate += row.linear[s].dot(link.velocity) + row.angular[s].dot(link.angular_velocity);
    }
    return rate;
}

/// Change of row i's rate by a unit impulse of row j.
TREAD_HD double coupling_of(const JointRow& i, const JointRow& j)
{
    double sum = 0;
    for (int s = 0; s < i.sides; ++s)
    {
        for (int t = 0; t < j.sides; ++t)
        {
            if (i.link[s] != j.link[t]) { continue; }
            sum += i.linear[s].dot(j.linear_response[t]) + i.angular[s].dot(j.angular_response[t]);
        }
    }
    return sum;
}

/// Sets the impulses of the rows at a bound, clears the others.
TREAD_HD void set_bound(const JointsView& joints, std::int64_t r)
{
    JointRow&          row   = joints.row[r];
    const std::int32_t state = joints.state[r];
    row.impulse              = state == row_at_low ? row.low : state == row_at_high ? row.high : 0.0;
}

/// Velocity of link k with the impulses of all rows.
template<class Lanes>
TREAD_HD void move_link(const JointsView& joints, std::int64_t k, const Lanes& lanes)
{
    Vec3<double> velocity = Vec3<double>::Zero(), spin = Vec3<double>::Zero();
    for_each_of(joints.rows_of_link, k, lanes,
                [&](std::int32_t r)
                {
                    const JointRow& row = joints.row[r];
                    for (int s = 0; s < row.sides; ++s)
                    {
                        if (row.link[s] != k) { continue; }
                        velocity += row.impulse * row.linear_response[s];
                        spin += row.impulse * row.angular_response[s];
                    }
                });
    for (int c = 0; c < 3; ++c)
    {
        velocity[c] = lanes.sum(velocity[c]);
        spin[c]     = lanes.sum(spin[c]);
    }
    if (lanes.lane() != 0) { return; }
    joints.moved[k].velocity         = joints.link[k].velocity + velocity;
    joints.moved[k].angular_velocity = joints.link[k].angular_velocity + spin;
}

/// Lower triangle of the system, with the right-hand side as its last row, row by row.
struct Triangle
{
    double* value;

    TREAD_HD double& operator()(std::int64_t row, std::int64_t column) const
    {
        return value[row * (row + 1) / 2 + column];
    }
};

/// Writes row i of the system and its right-hand side; rows at a bound are empty.
template<class Lanes>
TREAD_HD void write_system_row(const JointsView& joints, const Triangle& system, std::int64_t i, const Lanes& lanes)
{
    if (joints.state[i] != row_solved) { return; }
    const JointRow& row = joints.row[i];
    for_each_of(joints.elimination.before, i, lanes,
                [&](std::int32_t j)
                {
                    if (joints.state[j] == row_solved) { system(i, j) = coupling_of(row, joints.row[j]); }
                });
    if (lanes.lane() != 0) { return; }
    system(i, i)                = coupling_of(row, row) + row.softness;
    system(joints.row_count, i) = row.target - rate_of(row, joints.moved);
}

/// Finishes an entry of the factor L D L^T: of L D below the diagonal; on it, the inverse of the pivot, or 0 for a row
/// that depends on rows before it.
template<class Lanes>
TREAD_HD void finish_entry(const JointsView& joints, const Triangle& factor, const SystemEntry& entry,
                           const Lanes& lanes)
{
    double known = 0;
    for_each_of(joints.elimination.before, entry.column, lanes,
                [&](std::int32_t k) { known += factor(entry.row, k) * factor(entry.column, k) * factor(k, k); });
    known = lanes.sum(known);
    if (lanes.lane() != 0) { return; }
    double& value = factor(entry.row, entry.column);
    value -= known;
    if (entry.row != entry.column) { return; }
    value = value > least_pivot * joints.row[entry.row].diagonal ? 1 / value : 0.0;
}

/// Replaces the right-hand side of row k by its solution, after those of all rows below.
template<class Lanes>
TREAD_HD void substitute(const JointsView& joints, const Triangle& factor, std::int32_t k, const Lanes& lanes)
{
    const std::int64_t n     = joints.row_count;
    double             known = 0;
    for_each_of(joints.elimination.below, k, lanes, [&](std::int32_t i) { known += factor(i, k) * factor(n, i); });
    known = lanes.sum(known);
    if (lanes.lane() == 0) { factor(n, k) = factor(k, k) * (factor(n, k) - known); }
}

/// Writes the system, eliminates its rows step by step, and leaves the solution as the last row.
template<class Team>
TREAD_HD void solve_system(const JointsView& joints, const Triangle& factor, const Team& team)
{
    const EliminationView& plan = joints.elimination;
    for (std::int64_t i = team.lane(); i < factor_size(joints.row_count); i += team.lanes()) { factor.value[i] = 0; }
    team.sync();
    for (std::int64_t i = team.group(); i < joints.row_count; i += team.groups())
    {
        write_system_row(joints, factor, i, team.members());
    }
    team.sync();
    for (std::int64_t step = 0; step < plan.step_count; ++step)
    {
        for (std::int64_t e = plan.entries.first[step] + team.group(); e < plan.entries.first[step + 1];
             e += team.groups())
        {
            finish_entry(joints, factor, plan.entries.item[e], team.members());
        }
        team.sync();
    }
    for (std::int64_t step = plan.step_count - 1; step >= 0; --step)
    {
        for (std::int64_t p = plan.pivots.first[step] + team.group(); p < plan.pivots.first[step + 1];
             p += team.groups())
        {
            substitute(joints, factor, plan.pivots.item[p], team.members());
        }
        team.sync();
    }
}

/// Solves for the impulses of the rows that are not at a bound.
template<class Team>
TREAD_HD void solve_rows(const JointsView& joints, const Triangle& factor, const Team& team)
{
    const std::int64_t n = joints.row_count;
    for (std::int64_t r = team.lane(); r < n; r += team.lanes()) { set_bound(joints, r); }
    team.sync();
    for (std::int64_t k = team.group(); k < joints.link_count; k += team.groups())
    {
        move_link(joints, k, team.members());
    }
    team.sync();
    solve_system(joints, factor, team);
    for (std::int64_t r = team.lane(); r < n; r += team.lanes())
    {
        const bool there = factor(r, r) != 0;
        if (there) { joints.row[r].impulse = factor(n, r); }
        joints.row[r].skipped = joints.state[r] == row_solved && !there ? 1 : 0;
    }
    team.sync();
}

/// Moves a row with bounds to or from its bound, where the solution demands that.
TREAD_HD void update_state(const JointsView& joints, std::int64_t r)
{
    JointRow& row = joints.row[r];
    if (row.skipped != 0 || (row.low == -INFINITY && row.high == INFINITY)) { return; }
    std::int32_t& state = joints.state[r];
    if (state == row_solved)
    {
        if (row.impulse >= row.low && row.impulse <= row.high) { return; }
        state = row.impulse < row.low ? row_at_low : row_at_high;
    }
    else
    {
        const double missing = row.target - rate_of(row, joints.moved) - row.softness * row.impulse;
        const double wanted  = state == row_at_low ? missing : -missing; // in the direction away from the bound
        if (wanted <= bound_slack * std::fabs(row.target)) { return; }
        state = row_solved;
    }
    *joints.changed = 1;
}

/// Finds all impulses and the velocities with them. `factor` has room for factor_size(row_count) values.
template<class Team>
TREAD_HD void solve(const JointsView& joints, const Triangle& factor, const Team& team)
{
    for (int round = 0; round < most_rounds; ++round)
    {
        if (team.lane() == 0) { *joints.changed = 0; }
        solve_rows(joints, factor, team);
        for (std::int64_t k = team.group(); k < joints.link_count; k += team.groups())
        {
            move_link(joints, k, team.members());
        }
        team.sync();
        for (std::int64_t r = team.lane(); r < joints.row_count; r += team.lanes()) { update_state(joints, r); }
        team.sync();
        const bool done = *joints.changed == 0;
        team.sync();
        if (done) { return; }
    }
    for (std::int64_t r = team.lane(); r < joints.row_count; r += team.lanes())
    {
        JointRow& row = joints.row[r];
        row.impulse   = std::fmin(std::fmax(row.impulse, row.low), row.high);
    }
    team.sync();
}

} // namespace tread::dem::joint_solve
