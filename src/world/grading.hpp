#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.hpp"

namespace tread::world
{

/// Diameter (m) below which a share `u` in [0, 1] of the rocks lies: the inverse of the distribution by number.
double quantile(const scene::Diameter& diameter, double u);

/// Volume (m3) of the sphere of this diameter (m).
double sphere_volume(double diameter);

/// A rock before it is placed.
struct RockDraw
{
    double       diameter; ///< m
    std::int32_t member;   ///< index of the form in the shape's family
};

/// Draws the rocks of a table, the largest first: `count` of them, or as many as come nearest to `solid_fraction` of
/// `volume` (m3). Sizes and forms depend on the seed alone. InputError if the fraction requires over 1e8 rocks, or
/// less than one, or if the rocks' volume exceeds `volume`; EnvironmentError if they do not fit into memory.
std::vector<RockDraw> draw_rocks(const scene::Rocks& rocks, double volume, std::size_t members);

} // namespace tread::world
