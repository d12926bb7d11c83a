#pragma once

#include <cstdint>
#include <vector>

#include "solver/world.hpp"

namespace tread::solver
{

/// Equivalent radius of a body, m, under which sand samples it at nine places; 0 = never.
double sampled_below(const scene::Scene& scene, const HostPoints& points);

/// For each point of sand a body of [first, last) that it lies in or within its contact radius of (phi < r_p), itself
/// or one of its samples; -1 where there is none. Sand that starts in such contact would fly.
std::vector<std::int32_t> covering_bodies(const scene::Scene& scene, const World& world, std::size_t first,
                                          std::size_t last);

} // namespace tread::solver
