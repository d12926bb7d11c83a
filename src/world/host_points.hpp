#pragma once

#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace tread::world
{

/// Material points before they are copied to a backend; one entry per point in every array.
struct HostPoints
{
    std::vector<Vec3<double>>  position; ///< m
    std::vector<double>        volume;   ///< m3
    std::vector<double>        mass;     ///< kg
    std::vector<Sym3<double>>  stress;   ///< Pa
    std::vector<std::uint8_t>  material;
    std::vector<std::int32_t>  terrain;       ///< index of the [[terrain]] table that created the point
    std::vector<std::uint32_t> id;            ///< ascending, in the sand of the scene
    std::vector<Vec3<double>>  velocity;      ///< m/s; empty if all sand of the scene is at rest
    std::vector<double>        plastic_shear; ///< initial; empty without points of a saved bed in the scene

    std::size_t size() const { return position.size(); }
};

/// Bytes of a point at rest while it is made: its arrays and its place among the weights of its column.
std::int64_t bytes_of_made_point();

/// Makes the points of rows, each of which is a row of the sand or part of one, by ascending id. They have the stress
/// that the weight of all sand and rocks gives them (geostatic.hpp), or that of their saved bed. EnvironmentError where
/// they do not fit into memory.
HostPoints make_points(const scene::Scene& scene, const World& world, const std::vector<PointRow>& rows);

} // namespace tread::world
