#pragma once

#include "base/communicator.hpp"
#include "io/bed_file.hpp"
#include "io/snapshot.hpp"
#include "world/world.hpp"

// Sand that one run settles and others start with.
namespace tread::world
{

/// The points of all ranks with the volume and the stress that they have now; collective. `fields`: this rank's.
io::BedPoints saved_points(const Communicator& communicator, const scene::Scene& scene, const World& world,
                           const io::PointFields& fields);

/// Appends the points of the table's bed that are of its material, at rest where they lay. InputError, with file, key
/// and what is accepted, for a file that is no bed, and where scene and bed do not go together.
void append_saved_points(const scene::Scene& scene, std::size_t table, HostPoints& points);

} // namespace tread::world
