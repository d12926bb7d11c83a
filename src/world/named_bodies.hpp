#pragma once

#include "world/world.hpp"

namespace tread::world
{

/// The shape of a body: of a family of rocks, its first member.
scene::Shape body_shape(const scene::Scene& scene, const scene::Body& body);

/// Adds the scene's [[body]] tables to a world with sand and no rocks; InputError where one stands in a wall, the sand
/// or another. Those that stand on the surface wait far above all else.
void add_named_bodies(const scene::Scene& scene, World& world);

/// Puts those that stand on the surface there, when all rocks are placed; InputError as above.
void find_heights(const scene::Scene& scene, World& world);

} // namespace tread::world
