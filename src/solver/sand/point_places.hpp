#pragma once

#include <vector>

#include "kernels/mpm/points.hpp"
#include "world/terrain_bins.hpp"

namespace tread::solver
{

/// Appends the positions (m) of the points, in memory order; synchronises.
template<class Exec, class Real>
void append_positions(const mpm::Points<Exec, Real>& points, std::vector<Vec3<double>>& positions);

/// Adds the points as cubes of their present volume; synchronises.
template<class Exec, class Real>
void add_cubes(const mpm::Points<Exec, Real>& points, world::TerrainBins& bins);

} // namespace tread::solver
