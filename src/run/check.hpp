#pragma once

#include <string>

#include "base/communicator.hpp"
#include "scene/scene.hpp"

namespace tread::run
{

/// Returns the output of `tread check`: warnings, cost, slope, ground and grid resolution of each named body, the bed,
/// shapes, the partition over `ranks`, and the stages of a step with reasons.
std::string check_scene(const Communicator& communicator, const scene::Scene& scene, int ranks);

} // namespace tread::run
