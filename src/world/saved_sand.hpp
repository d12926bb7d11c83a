#pragma once

#include "base/communicator.hpp"
#include "io/bed_file.hpp"
#include "io/snapshot.hpp"
#include "world/world.hpp"

// Saves sand that one run settles, and loads it in others.
namespace tread::world
{

/// Collects the points of all ranks with their present volume and stress; collective. `fields`: this rank's.
io::BedPoints saved_points(const Communicator& communicator, const scene::Scene& scene, const World& world,
                           const io::PointFields& fields);

/// Appends the points of the table's bed that have its material, at rest at their saved positions. InputError, with
/// file, key and accepted values, for a file that is not a bed, and where scene and bed do not match.
void append_saved_points(const scene::Scene& scene, std::size_t table, Sand& sand);

} // namespace tread::world
