#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "world/sand_map.hpp"
#include "world/world.hpp"

// What the layers hold in which rocks stand in sand.
namespace tread::world
{

/// Void of a layer above which a scene is refused, unless its table has allow_voids.
constexpr double most_void = 0.05;

/// The sand in a table's region between floor and height before rocks take its place.
struct Layer
{
    std::size_t               table; ///< of Scene::rocks
    double                    sand;  ///< m3
    double                    rock;  ///< m3, of the rocks of all tables with their centre there, as far as sand stands
    double                    rock_radius;  ///< m, mean of the table's own rocks
    double                    point_radius; ///< m, largest contact radius of the points there
    std::vector<std::uint8_t> holds;        ///< of each point: 1 = it stands there
};

/// Estimates for each body the share of its volume that stands in sand, by some 250 samples; 0 for named bodies.
std::vector<double> shares_in_sand(const World& world, const SandMap& sand);

Layer find_layer(const scene::Scene& scene, std::size_t table, const World& world, const std::vector<double>& in_sand);

/// Computes a layer's fractions once the points with kept[i] = 0 are removed. A point counts where it stood at first.
LayerShares shares_of(const Layer& layer, const HostPoints& points, const std::vector<std::uint8_t>& kept);

/// InputError for the first layer with more void than it may have, with what would do.
void require_no_voids(const scene::Scene& scene, const World& world);

/// What finer points would do for tables whose rocks are smaller than two contact radii of the points around them.
std::vector<std::string> layer_advice(const scene::Scene& scene, const World& world);

} // namespace tread::world
