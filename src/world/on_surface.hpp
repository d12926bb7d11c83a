#pragma once

#include "world/world.hpp"

namespace tread::world
{

/// Puts a named body, whose x and y are known, above the sand and the rocks under it: as low as a body that comes down
/// from above meets neither, sand by the contact radius of its points, and `gap` (m) higher. All rocks count, those
/// that are to fall from above, too. InputError where nothing lies under the body.
void stand_on_surface(const scene::Scene& scene, std::size_t body, double gap, World& world);

} // namespace tread::world
