#pragma once

#include "world/grading.hpp"
#include "world/region.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// Space where the rocks of a table may be.
Space rocks_space(const scene::Scene& scene, std::size_t table);

/// Shapes from which the rocks of a table are drawn.
std::vector<scene::Shape> rocks_family(const scene::Scene& scene, std::size_t table);

/// Adds the drawn rocks of a [[rocks]] table to the world: at random or on a lattice in the table's space, with random
/// orientations, reproducible from the seed on every machine. All surface nodes of a rock lie in the space, and keep a
/// distance of 1 % of the smaller radius from every other body. InputError, with the number placed, if not all find
/// room.
void place_rocks(const scene::Scene& scene, std::size_t table, const std::vector<RockDraw>& rocks, World& world);

} // namespace tread::world
