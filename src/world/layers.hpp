#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "world/sand_map.hpp"
#include "world/world.hpp"

// Composition (sand, rock, void) of the layers in which rocks lie in sand.
namespace tread::world
{

/// Void fraction of a layer above which a scene is refused, unless its table has allow_voids.
constexpr double most_void = 0.05;

/// The sand in a table's region between floor and height before rocks replace part of it.
struct Layer
{
    std::size_t       table;        ///< index into Scene::rocks
    double            sand;         ///< m3
    double            rock;         ///< m3, rocks of all tables with their centre there, as far as they lie in sand
    double            rock_radius;  ///< m, mean over the table's own rocks
    double            point_radius; ///< m, largest contact radius of the points there
    std::vector<bool> holds;        ///< for each point: whether it lies in the layer
};

/// Estimates for each body the share of its volume that lies in sand, by some 250 samples; 0 for named bodies.
std::vector<double> shares_in_sand(const World& world, const SandMap& sand);

Layer find_layer(const scene::Scene& scene, std::size_t table, const World& world, const std::vector<double>& in_sand);

/// Computes a layer's fractions without the points for which kept[i] is false. A point belongs to the layer by its
/// initial position.
LayerShares shares_of(const Layer& layer, const Sand& sand, const std::vector<bool>& kept);

/// Throws InputError for the first layer with more void than allowed, with a remedy.
void require_no_voids(const scene::Scene& scene, const World& world);

/// Advises finer points for tables whose rocks are smaller than two contact radii of the points around them.
std::vector<std::string> layer_advice(const scene::Scene& scene, const World& world);

} // namespace tread::world
