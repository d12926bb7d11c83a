#pragma once

#include "solver/world.hpp"

namespace tread::solver
{

/// Adds the rocks of one [[rocks]] table to the world: at random or on a lattice in the region, with random
/// orientations, the same for a seed on every machine. No two bodies' bounding spheres overlap, nor a wall. With
/// placement "replace" the points with phi < r_p are removed; otherwise sand in the way is an InputError.
void place_rocks(const scene::Scene& scene, const scene::Rocks& rocks, World& world);

/// Removes points with phi < r_p of the world's body `body`; returns how many.
std::int64_t remove_points_in_body(const scene::Scene& scene, World& world, std::size_t body);

} // namespace tread::solver
