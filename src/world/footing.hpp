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
    int    material; ///< of Scene::materials, at the surface
    double top;      ///< m, of the highest point under the body
    double depth;    ///< m, from there to the lowest point
    double beside;   ///< m of bed beside the body's nearer side; negative where the body reaches beyond it
    bool   walled;   ///< the bed ends there at a wall of the domain, not at a free edge
};

/// A named body and what it is to stand on.
struct Footing
{
    std::size_t           body; ///< of Scene::bodies
    bool                  driven;
    double                load;   ///< N, its weight
    double                radius; ///< m; of a body that is neither wheel nor ball, half its height
    double                width;  ///< m, along y
    std::optional<Ground> ground; ///< none where no sand lies under it
    std::optional<double> gap;    ///< m, to the nearest sand or rock under it; none where there is neither
    std::optional<Patch>  patch;  ///< of a wheel or ball at rest on that ground; none without weight
};

std::vector<Footing> footings(const scene::Scene& scene, const World& world);

/// Whether some phase drives the body.
bool is_driven(const scene::Scene& scene, const scene::Body& body);

} // namespace tread::world
