#pragma once

#include <vector>

#include "world/world.hpp"

namespace tread::world
{

/// Counts, masses and moments that identify a world: an unchanged scene builds another world when a file that it names
/// (mesh, heights, settled bed) has changed.
std::vector<double> measures(const World& world);

/// Whether two worlds agree by these measures, up to the rounding of different machines.
bool are_same(const std::vector<double>& one, const std::vector<double>& other);

} // namespace tread::world
