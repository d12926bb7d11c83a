#pragma once

#include <string>

#include "base/communicator.hpp"
#include "scene/scene.hpp"

namespace tread::run
{

enum class CheckForm
{
    page,             ///< for people
    page_with_stages, ///< the same, with the stages of a step and why each is on or off
    json              ///< for programs
};

/// Returns the output of `tread check`: warnings, cost, phases, slope, ground and grid resolution of each named body,
/// the bed, shapes, and the partition over `ranks`.
std::string check_scene(const Communicator& communicator, const scene::Scene& scene, int ranks, CheckForm form);

} // namespace tread::run
