#pragma once

#include <vector>

#include "world/world.hpp"

namespace tread::world
{

/// Counts, masses and moments that identify a world: an unchanged scene builds another world when a file that it names
/// (mesh, heights, settled bed) has changed. `bodies`: body_measures() of the world before its rocks were released.
std::vector<double> measures(const World& world, const std::vector<double>& bodies);
std::vector<double> body_measures(const HostBodies& bodies);

/// Whether two worlds agree by these measures, up to the rounding of different machines.
bool are_same(const std::vector<double>& one, const std::vector<double>& other);

} // namespace tread::world
