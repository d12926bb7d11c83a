#pragma once

#include <cstddef>
#include <vector>

#include "world/world.hpp"

namespace tread::world
{

/// Makes room in the sand for all placed rocks and says what their layers hold then (World::layers).
///
/// Tables with placement "replace" or "points": sand of the volume of the rocks that stand in it goes, whole points,
/// from each rock those that lie deepest in it. What is left of a point's volume passes on to the next rock, so that
/// mass is kept to one point. Points that stay and touch a body are pushed off it, by no more than a grid cell, within
/// the sand of their table; one that finds no place goes, and leaves a void.
///
/// Other tables: sand in the way is an InputError. Rocks and points of one saved bed have their room already.
void make_room(const scene::Scene& scene, World& world);

} // namespace tread::world
