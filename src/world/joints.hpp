#pragma once

#include <vector>

#include "kernels/dem/joints/joint.hpp"
#include "scene/scene.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// Makes the joints of a scene between its placed bodies. InputError, with the joint's line, where joints close a loop
/// twice, so that their forces are not determined.
std::vector<dem::Joint> make_joints(const scene::Scene& scene, const HostBodies& bodies);

/// Sets speeds and largest torques of the motors to those of a phase of the scene.
void set_motors(const scene::Scene& scene, std::size_t phase, std::vector<dem::Joint>& joints);

} // namespace tread::world
