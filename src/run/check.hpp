#pragma once

#include <string>

#include "base/communicator.hpp"
#include "scene/scene.hpp"

namespace tread::run
{

/// What `tread check` prints: warnings, cost, slope, what each named body stands on and how well the grid resolves it,
/// the bed, shapes, how the scene falls to so many ranks, and the stages of a step with reasons.
std::string check_scene(const Communicator& communicator, const scene::Scene& scene, int ranks);

} // namespace tread::run
