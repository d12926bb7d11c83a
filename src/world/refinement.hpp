#pragma once

#include "kernels/mpm/grid/levels.hpp"
#include "scene/scene.hpp"

namespace tread::world
{

/// Grid levels of a scene: each box of [grid] refine is extended to whole cells of the next coarser level. InputError
/// if a box is not inside the one before, or too near a wall.
mpm::Refinement refinement_of(const scene::Scene& scene);

/// Level of the grid at a position (m): 0 outside the boxes.
int level_at(const scene::Scene& scene, const mpm::Refinement& refinement, const Vec3<double>& position);

/// The box of a level >= 1, m.
scene::Box box_of(const scene::Scene& scene, const mpm::Refinement& refinement, int level);

} // namespace tread::world
