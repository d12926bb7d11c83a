#pragma once

#include "world/world.hpp"

namespace tread::world
{

/// Sets the stress at rest under gravity along z. sigma_v is the weight above, of sand and of bodies after the first
/// `named`, in columns of the plan as wide as a cell; sigma_h = max(K0 sigma_v, Ka sigma_v - 2 c sqrt(Ka)), K0 = nu/(1
/// - nu), Ka = (1 - sin phi)/(1 + sin phi) (docs/theory.md#geostatic-stress). Exact for level beds, a first guess for
/// others. Terrain with an initial velocity is not at rest: it is left without stress and loads nothing.
void set_geostatic_stress(const scene::Scene& scene, const HostBodies& bodies, HostPoints& points);

} // namespace tread::world
