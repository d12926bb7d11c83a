#pragma once

#include "world/world.hpp"

namespace tread::world
{

/// Shape of a body; of a family of rocks, its first member.
scene::Shape body_shape(const scene::Scene& scene, const scene::Body& body);

/// Adds the scene's [[body]] tables to a world with sand and no rocks; InputError where one intersects a wall, the
/// sand or another. Bodies that are to stand on the surface are kept far above everything else.
void add_named_bodies(const scene::Scene& scene, World& world);

/// Places the bodies that stand on the surface, after all rocks are placed; InputError as above.
void find_heights(const scene::Scene& scene, World& world);

} // namespace tread::world
