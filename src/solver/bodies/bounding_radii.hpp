#pragma once

#include <vector>

#include "world/world.hpp"

namespace tread::solver
{

/// Computes the radius (m) of every body's bounding sphere about its centre of mass.
inline std::vector<double> bounding_radii(const world::World& world)
{
    world.bodies.require_rocks();
    std::vector<double> radii;
    radii.reserve(world.bodies.size());
    for (std::size_t b = 0; b < world.bodies.size(); ++b)
    {
        const auto shape = static_cast<std::size_t>(world.bodies.shape[b]);
        radii.push_back(world.templates[shape].bounding_radius * world.bodies.scale[b]);
    }
    return radii;
}

} // namespace tread::solver
