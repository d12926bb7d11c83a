#pragma once

#include "world/grading.hpp"
#include "world/region.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// Where the rocks of a table may be.
Space rocks_space(const scene::Scene& scene, std::size_t table);

/// The shapes that the rocks of a table are drawn from.
std::vector<scene::Shape> rocks_family(const scene::Scene& scene, std::size_t table);

/// Adds the drawn rocks of a [[rocks]] table to the world: at random or on a lattice in the table's space, with random
/// orientations, the same for a seed on every machine. A rock lies whole in the space by its surface nodes, and keeps
/// 1 % of the smaller radius from every other body, by the surface nodes of both. InputError, with how many were
/// placed, if not all find room.
void place_rocks(const scene::Scene& scene, std::size_t table, const std::vector<RockDraw>& rocks, World& world);

} // namespace tread::world
