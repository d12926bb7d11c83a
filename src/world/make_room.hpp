#pragma once

#include <cstddef>
#include <vector>

#include "world/world.hpp"

namespace tread::world
{

/// Removes or moves sand so that no point touches a placed rock, and fills in World::layers.
///
/// Tables with placement "replace" or "points": whole sand points of the volume of the rocks that lie in sand are
/// removed, from each rock those deepest in it. The rest of a point's volume is carried over to the next rock, so that
/// mass is conserved to one point. Remaining points that touch a body are pushed off it, by at most a grid cell,
/// within the sand of their table; a point that finds no free place is removed, and leaves a void.
///
/// Other tables: sand in the way is an InputError. Rocks and points of one saved bed do not overlap already.
void make_room(const scene::Scene& scene, World& world);

} // namespace tread::world
