#pragma once

#include <optional>
#include <vector>

#include "world/bearing.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// Ground under a named body at the start.
struct Ground
{
    int    material; ///< index into Scene::materials, at the surface
    double top;      ///< m, height of the highest point under the body
    double depth;    ///< m, from there down to the lowest point
    double beside;   ///< m, extent of the bed beside the nearer side of the body; negative where the body overhangs
    bool   walled;   ///< the bed ends there at a wall of the domain, not at a free edge
};

/// A named body and the ground under it.
struct Footing
{
    std::size_t           body; ///< index into Scene::bodies
    bool                  driven;
    double                load;   ///< N, its weight
    double                radius; ///< m; half the height of a body that is neither wheel nor ball
    double                width;  ///< m, along y
    std::optional<Ground> ground; ///< empty where no sand lies under the body
    std::optional<double> gap;    ///< m, to the nearest sand or rock under the body; empty where there is neither
    std::optional<Patch>  patch;  ///< patch of a wheel or ball at rest on that ground; empty without weight
};

std::vector<Footing> footings(const scene::Scene& scene, const World& world);

/// Whether a phase drives the body.
bool is_driven(const scene::Scene& scene, const scene::Body& body);

} // namespace tread::world
