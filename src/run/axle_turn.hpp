#pragma once

#include "solver/bodies/body_command.hpp"
#include "solver/bodies/body_row.hpp"

namespace tread::run
{

/// Rotation of a named body about its axle since the last row of the time series.
struct AxleTurn
{
    double spin   = 0; ///< rad/s, at the last row
    double angle  = 0; ///< rad, turned in steps with a commanded spin
    double driven = 0; ///< s, duration of these steps
    double free   = 0; ///< s, duration of all others
};

/// Adds a step of `dt` (s) under a command.
inline void add_step(AxleTurn& turn, const solver::BodyCommand& command, double dt)
{
    if (!command.spin)
    {
        turn.free += dt;
        return;
    }
    turn.angle += *command.spin * dt;
    turn.driven += dt;
}

/// Mean spin (rad/s) since the last row, of an axle that has `spin` (rad/s) now. A commanded spin is followed exactly,
/// as it may jump at the start of a phase; a free one changes by its angular momentum, and has the mean of both ends.
inline double mean_spin(const AxleTurn& turn, double spin)
{
    const double span = turn.driven + turn.free;
    return span > 0 ? (turn.angle + turn.free * 0.5 * (turn.spin + spin)) / span : spin;
}

/// Mean power (W) that the axle supplied since the last row: minus the mean torque about the axle, times the mean spin.
inline double mean_power(const AxleTurn& turn, const solver::BodyRow& row)
{
    return -row.torque.dot(row.axle) * mean_spin(turn, spin_of(row));
}

} // namespace tread::run
