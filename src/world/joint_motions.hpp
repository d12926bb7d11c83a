#pragma once

#include <vector>

#include "kernels/dem/joints/joint.hpp"
#include "scene/scene.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// Throws InputError, with the line of the phase, if what a phase prescribes of bodies pulls a joint apart: two bodies
/// of a weld with different velocities, say. Looks at the phases that begin with the bodies as placed, because all
/// before them hold every jointed body; elsewhere a joint that drifts stops the run.
void require_consistent_motions(const scene::Scene& scene, const std::vector<dem::Joint>& joints,
                                const HostBodies& bodies);

} // namespace tread::world
