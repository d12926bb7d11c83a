#pragma once

#include "io/snapshot.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// Volume of the rocks over the volume between the domain's floor and the surface of the bed seen from above: the top
/// of the highest rock in each column of a lattice (of a 32nd of the rocks' mean diameter, or of about a million
/// columns where there would be more). Valid for heaps and for filled boxes; hollows of the surface, and gaps beside
/// walls that are open down to the floor, count as outside. 0 without rocks.
double packing_fraction(const World& world, const io::BodyFields& bodies);

} // namespace tread::world
