#pragma once

#include "io/snapshot.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// Volume of the rocks over the volume between the domain's floor and the surface of the bed as it is seen from above:
/// in each of the columns of a lattice (of a sixteenth of the rocks' mean diameter) the top of its highest rock. Holds
/// for heaps as for filled boxes; hollows of the surface and gaps beside walls that are seen through to the floor count
/// as outside. 0 without rocks.
double packing_fraction(const World& world, const io::BodyFields& bodies);

} // namespace tread::world
