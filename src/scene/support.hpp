#pragma once

#include <cstddef>

#include "scene/scene.hpp"

namespace tread::scene
{

/// Whether something can take up a force on a body (index) in a phase (index): joints and pairs that touch lead from it
/// to the world, a wall, terrain, rocks, or another body that the phase holds or leads.
bool has_support(const Scene& scene, std::size_t phase, std::size_t body);

} // namespace tread::scene
