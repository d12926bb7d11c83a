#pragma once

#include <vector>

#include "world/world.hpp"

namespace tread::world
{

/// Counts, masses and moments by which a world is known again: a scene of the same text builds another one when a file
/// that it names (mesh, heights, settled bed) has changed since.
std::vector<double> measures(const World& world);

/// Whether worlds of these measures are the same but for the rounding of the machines that built them.
bool are_same(const std::vector<double>& one, const std::vector<double>& other);

} // namespace tread::world
