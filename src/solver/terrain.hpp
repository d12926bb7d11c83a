#pragma once

#include "solver/world.hpp"

namespace tread::solver
{

/// Points of all [[terrain]] tables: a lattice of cube-root(points_per_cell) a cell and axis, cell-centred, each point
/// with an equal share of its cell. A later table replaces the points of an earlier one inside its region.
HostPoints make_terrain(const scene::Scene& scene);

/// Distance of neighbouring points, m: the smallest of all terrain tables; 0 without one.
double terrain_spacing(const scene::Scene& scene);

/// Stress at rest under gravity along z: sigma_v is the weight above (sand and bodies after the first `named`),
/// sigma_h = max(K0 sigma_v, Ka sigma_v - 2 c sqrt(Ka)), K0 = nu/(1 - nu), Ka = (1 - sin phi)/(1 + sin phi)
/// (verification C2). Exact for level beds, a first guess for others.
void set_geostatic_stress(const scene::Scene& scene, const HostBodies& bodies, HostPoints& points);

} // namespace tread::solver
