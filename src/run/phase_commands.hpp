#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "run/phases.hpp"
#include "solver/bodies/body_command.hpp"
#include "world/world.hpp"

namespace tread::run
{

/// Command of the running phase to named body `body` at `time` (s); `rolling_radius`: m, of that body.
solver::BodyCommand command_of(const scene::Scene& scene, const RunningPhase& phase, std::size_t body,
                               double rolling_radius, double time);

/// Sets the commands of all named bodies, as command_of; `rolling_radii`: m, of the named bodies.
void set_commands(std::vector<solver::BodyCommand>& commands, const scene::Scene& scene, const RunningPhase& phase,
                  const std::vector<double>& rolling_radii, double time);

/// Converts the words x y z roll pitch yaw to bits of dem::LockedFreedom.
std::uint32_t locked_freedoms(const std::vector<std::string>& words);

/// Radius (m) on which slip is based: the body's rolling_radius, or the wheel's including its grousers. `scale`: the
/// body's.
double rolling_radius(const scene::Body& body, const shape::ShapeTemplate& form, double scale);

/// Rolling radii (m) of all named bodies.
std::vector<double> rolling_radii(const scene::Scene& scene, const world::World& world);

} // namespace tread::run
