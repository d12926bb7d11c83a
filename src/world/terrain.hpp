#pragma once

#include "world/world.hpp"

namespace tread::world
{

/// Builds the sand of all [[terrain]] tables in their regions, from floor to height. With points_per_cell: a
/// cell-centred lattice with the cube root of that number per cell and axis, in the cells of the local grid level.
/// With spacing: a lattice that begins half a spacing inside the low corner of the region's bounds. Each point has the
/// volume of its lattice cell. A later table replaces the points of an earlier one in the space that it fills.
/// InputError if a table has no point.
Sand make_terrain(const scene::Scene& scene, const mpm::Refinement& refinement = {});

/// Distance between neighbouring points of a table outside refined boxes, m.
double lattice_spacing(const scene::Scene& scene, const scene::Terrain& terrain);

/// Smallest point spacing of all terrain tables, m; 0 without one. Points of a saved bed count by their volume.
double terrain_spacing(const scene::Scene& scene, const Sand& sand);

} // namespace tread::world
