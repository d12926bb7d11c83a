#pragma once

#include "world/host_points.hpp"

namespace tread::world
{

/// Bytes of a point or body in the list of weights that set_geostatic_stress sorts.
constexpr std::size_t bytes_of_weight = 32;

/// Sets the stress at rest under gravity along z. sigma_v is the weight above, of sand and of bodies after the first
/// `named`, in columns of the plan as wide as a cell; sigma_h = max(K0 sigma_v, Ka sigma_v - 2 c sqrt(Ka)), K0 = nu/(1
/// - nu), Ka = (1 - sin phi)/(1 + sin phi) (docs/theory.md#geostatic-stress). Exact for level beds, a first guess for
/// others. Terrain with an initial velocity is not at rest: it is left without stress and loads nothing. `points`: any
/// points of the sand; all sand of their columns counts, so that the bits do not depend on which they are.
void set_geostatic_stress(const scene::Scene& scene, const HostBodies& bodies, const Sand& sand, HostPoints& points);

} // namespace tread::world
