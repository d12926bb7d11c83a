#pragma once

#include <cmath>

#include "kernels/dem/joints/joint_system_kern.hpp"

// Solves the rows of all joints for their impulses. Those with bounds are found by active sets: what is over a bound is
// held there, and the rest is solved again.
namespace tread::dem::joint_solve
{

/// Rows that yield less than this share of what their bodies without locks would are held: their impulses are not
/// determined.
inline constexpr double least_yield = 1e-12;

/// Largest number of solves in a substep. The states are kept, so that later substeps go on where this one stopped.
inline constexpr int most_rounds = 8;

/// Share of a row's target by which it may miss it at a bound, against rounding.
inline constexpr double bound_slack = 1e-9;

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
    double diagonal = 0, unlocked = 0;
    for (int s = 0; s < row.sides; ++s)
    {
        const JointLink    link   = joints.link[row.link[s]];
        const Vec3<double> linear = row.linear[s], angular = row.angular[s];
        const Vec3<double> moves = link.mobility * linear, turns = link.response * angular;
        row.linear_response[s]  = moves;
        row.angular_response[s] = turns;
        diagonal += linear.dot(moves) + angular.dot(turns);
        unlocked += link.inverse_mass * linear.squaredNorm() + link.inverse_inertia * angular.squaredNorm();
    }
    row.diagonal = diagonal;
    if (diagonal <= least_yield * unlocked) { hold(row); }
    row.softness += row.relative_softness * row.diagonal;
    row.diagonal += row.softness;
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

/// Solves for the impulses of the rows that are not at a bound.
template<class Team>
TREAD_HD void solve_rows(const JointsView& joints, const Triangle& factor, const Team& team)
{
    const auto n = static_cast<std::int32_t>(joints.row_count);
    for (auto r = static_cast<std::int32_t>(team.lane()); r < n; r += static_cast<std::int32_t>(team.lanes()))
    {
        set_bound(joints, r);
    }
    team.sync();
    for (std::int64_t k = team.group(); k < joints.link_count; k += team.groups())
    {
        move_link(joints, k, team.members());
    }
    team.sync();
    solve_system(joints, factor, team);
    for (auto r = static_cast<std::int32_t>(team.lane()); r < n; r += static_cast<std::int32_t>(team.lanes()))
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
