#pragma once

#include <cstddef>
#include <vector>

#include "shape/surface_samples.hpp"

// Positions of nodes among the samples of a surface.
namespace tread::shape
{

/// Selects `count` samples (all, if there are fewer), spaced as evenly as possible: the most crowded sample is
/// eliminated repeatedly (Yuksel 2015, Comput. Graph. Forum 34:25). Corners and edges are crowded only by samples of
/// their own kind or sharper ones.
std::vector<std::size_t> spread(const SurfaceSamples& samples, std::size_t count);

/// Replaces the given samples by evenly spaced ones: each moves to the centre of its Voronoi cell, several times (Lloyd
/// 1982, IEEE Trans. Inf. Theory 28:129). Corners do not move, and edges keep their samples.
std::vector<std::size_t> evened(const SurfaceSamples& samples, std::vector<std::size_t> places);

/// Nearest of `places` to each sample, on its side of a thin wall.
std::vector<std::size_t> nearest_places(const SurfaceSamples& samples, const std::vector<std::size_t>& places);

} // namespace tread::shape
