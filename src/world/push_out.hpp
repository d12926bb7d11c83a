#pragma once

#include <cstdint>
#include <optional>

#include "world/body_grid.hpp"
#include "world/cover.hpp"
#include "world/sand_map.hpp"

namespace tread::world
{

/// What a point of sand may not touch, and where it may be.
struct Surroundings
{
    const World&      world;
    const BodyGrid&   grid;
    const PointReach& reach;
    const SandMap&    sand;
    double            farthest; ///< m, that a point may be moved
};

/// The nearest place found for point i at which it touches no body: down the gradients of the signed distances, from
/// where it is, else from places around. Depends on nothing but the bodies and i; threads may ask at the same time.
std::optional<Vec3<double>> free_place(const Surroundings& near, std::size_t i);

} // namespace tread::world
