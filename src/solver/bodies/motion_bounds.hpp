#pragma once

#include <limits>

#include "scene/scene.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Bounds on what the prescribed motions of all phases do to bodies, for the choice of the time step.
struct MotionBounds
{
    double acceleration = 0; ///< m/s2, of any point of a body, by forces, torques, loads and carriages
    double longest_step = std::numeric_limits<double>::infinity(); ///< s, that resolves the springs of carriages
};

/// m/s2, largest acceleration of any point of named body `body` by a force (N) and a torque (N m) in any direction.
double acceleration_by(const world::World& world, std::size_t body, double force, double torque);

MotionBounds motion_bounds(const scene::Scene& scene, const world::World& world);

} // namespace tread::solver
