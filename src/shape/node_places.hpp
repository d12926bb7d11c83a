#pragma once

#include <cstddef>
#include <vector>

#include "shape/surface_samples.hpp"

// Where nodes stand among the samples of a surface.
namespace tread::shape
{

/// `count` samples (all, if there are no more) about as far apart as can be. The most crowded is taken away again and
/// again (Yuksel 2015, Comput. Graph. Forum 34:25); corners and edges are crowded by their own kind and sharper alone.
std::vector<std::size_t> spread(const SurfaceSamples& samples, std::size_t count);

/// Samples in even places instead of the given ones: each goes to the middle of what is nearer to it than to the
/// others, several times (Lloyd 1982, IEEE Trans. Inf. Theory 28:129). Corners stay and edges keep theirs.
std::vector<std::size_t> evened(const SurfaceSamples& samples, std::vector<std::size_t> places);

/// Which of `places` each sample is nearest to, on its side of a thin wall.
std::vector<std::size_t> nearest_places(const SurfaceSamples& samples, const std::vector<std::size_t>& places);

} // namespace tread::shape
