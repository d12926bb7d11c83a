#pragma once

#include <cstdint>
#include <optional>

#include "world/body_grid.hpp"
#include "world/cover.hpp"
#include "world/sand_map.hpp"

namespace tread::world
{

/// Constraints on a sand point that is moved: bodies that it must not touch, and the region where it must stay.
struct Surroundings
{
    const World&      world;
    const BodyGrid&   grid;
    const PointReach& reach;
    const SandMap&    sand;
    double            farthest; ///< m, largest distance that a point may be moved
};

/// Finds the nearest place at which a point touches no body, along the gradients of the signed distances: from its
/// position, else from places around it. Depends only on the bodies and the point; thread-safe.
std::optional<Vec3<double>> free_place(const Surroundings& near, const SandPoint& point);

} // namespace tread::world
