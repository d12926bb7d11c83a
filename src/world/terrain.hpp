#pragma once

#include "world/world.hpp"

namespace tread::world
{

/// Points of all [[terrain]] tables where their regions are, from floor to height. With points_per_cell a lattice of
/// its cube root a cell and axis, cell-centred, of the cells of the level that the grid has there; with spacing a
/// lattice from half a spacing inside the low corner of the region's bounds. Each point has the volume of its share of
/// the lattice. A later table replaces the points of an earlier one inside what it fills. InputError if a table has no
/// point.
HostPoints make_terrain(const scene::Scene& scene, const mpm::Refinement& refinement = {});

/// Distance of neighbouring points of a table outside refined boxes, m.
double lattice_spacing(const scene::Scene& scene, const scene::Terrain& terrain);

/// The smallest of all terrain tables, m; 0 without one. Points of a saved bed count by their volume.
double terrain_spacing(const scene::Scene& scene, const HostPoints& points);

} // namespace tread::world
