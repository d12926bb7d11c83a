#pragma once

#include "world/grading.hpp"
#include "world/region.hpp"
#include "world/world.hpp"

// Finding room for rocks. All ways add rocks to the world in the order given, until one finds none, and return how
// many.
namespace tread::world
{

/// Random sequential adsorption: a rock is put at random places until it touches nothing. A rock is given up after 5e4
/// places that it cannot take, a table after 1e5 + 1000 a rock.
std::size_t place_at_random(const scene::Scene& scene, std::size_t table, const Space& space,
                            const std::vector<RockDraw>& rocks, World& world);

/// Where points of sand stand, in a random order: a rock is turned up to 20 times until it touches nothing; after that
/// the next point is tried.
std::size_t place_at_points(const scene::Scene& scene, std::size_t table, const Space& space,
                            const std::vector<RockDraw>& rocks, World& world);

/// On a cubic lattice that begins at the region's low corner, x fastest, each rock turned at random: as wide as the
/// largest bounding sphere if all find room, else narrowed by steps of 3 % down to 60 % of it. There a rock is turned
/// up to 20 times until it touches nothing; after that its site stays empty.
std::size_t place_on_lattice(const scene::Scene& scene, std::size_t table, const Space& space,
                             const std::vector<RockDraw>& rocks, World& world);

} // namespace tread::world
