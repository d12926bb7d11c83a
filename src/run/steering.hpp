#pragma once

#include <array>
#include <optional>
#include <string>

#include "run/phases.hpp"
#include "solver/bodies/body_command.hpp"
#include "world/world.hpp"

// What a visitor sets of a named body or of a motor, on top of the keys of the running phase.
namespace tread::run
{

/// Velocities replace those of the phase; forces and torques act besides its own.
struct BodySteering
{
    std::optional<double> spin    = {};  ///< rad/s about the axle
    std::optional<double> forward = {};  ///< m/s along x of the body's motion, or of the world
    std::array<double, 3> force{};       ///< N, world frame
    std::array<double, 3> torque{};      ///< N m, world frame
    double                axle_torque{}; ///< N m about the body's own y axis

    bool has_effort() const { return force != decltype(force){} || torque != decltype(torque){} || axle_torque != 0; }
};

struct MotorSteering
{
    double                speed       = 0;  ///< rad/s
    std::optional<double> most_torque = {}; ///< N m; empty: as before
};

/// InputError, with what the phase would need, where it does not let the body be steered so: a held or lowered body;
/// velocities that its motion leaves free; forces on a body without a motion; a torque about an axle that is held;
/// numbers that are not finite.
void require_steerable(const scene::Scene& scene, const RunningPhase& phase, std::size_t body,
                       const BodySteering& wish);

/// InputError if the joint has no motor, the speed is not finite or the torque is negative.
void require_steerable(const scene::Joint& joint, const MotorSteering& wish);

/// Changes the command of a phase to a body.
void steer(solver::BodyCommand& command, const BodySteering& wish);

/// m/s2, largest acceleration of any point of a named body by the efforts of `wish`.
double acceleration_by(const world::World& world, std::size_t body, const BodySteering& wish);

} // namespace tread::run
