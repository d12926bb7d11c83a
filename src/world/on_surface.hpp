#pragma once

#include "world/world.hpp"

namespace tread::world
{

/// Places a named body with known x and y above the sand and rocks under it: at the lowest height that a body coming
/// down from above reaches without contact (sand by the contact radius of its points), plus `gap` (m). All rocks
/// count, also those that are to fall. InputError where nothing lies under the body.
void stand_on_surface(const scene::Scene& scene, std::size_t body, double gap, World& world);

} // namespace tread::world
