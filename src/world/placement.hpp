#pragma once

#include "world/grading.hpp"
#include "world/region.hpp"
#include "world/world.hpp"

// Placement of rocks. Each function adds rocks to the world in the order given, until one finds no room, and returns
// how many it added.
namespace tread::world
{

/// Random sequential adsorption: tries random places for a rock until it touches nothing. Gives up a rock after 5e4
/// rejected places, a table after 1e5 + 1000 per rock.
std::size_t place_at_random(const scene::Scene& scene, std::size_t table, const Space& space,
                            const std::vector<RockDraw>& rocks, World& world);

/// Tries the positions of sand points in a random order: a rock gets up to 20 random orientations until it touches
/// nothing; then the next point is tried.
std::size_t place_at_points(const scene::Scene& scene, std::size_t table, const Space& space,
                            const std::vector<RockDraw>& rocks, World& world);

/// Uses a cubic lattice that begins at the region's low corner, x fastest, with random orientations. Its spacing is
/// the largest bounding diameter if all rocks find room, else it is reduced in steps of 3 % down to 60 %. At a reduced
/// spacing a rock gets up to 20 orientations until it touches nothing; then its site stays empty.
std::size_t place_on_lattice(const scene::Scene& scene, std::size_t table, const Space& space,
                             const std::vector<RockDraw>& rocks, World& world);

} // namespace tread::world
