#pragma once

#include "scene/scene.hpp"

namespace tread::scene
{

/// Computes the vector of gravity (m/s2) on a slope with given gravity, in axes that follow the ground: z is normal to
/// it. The ground rises by `angle_deg` along (cos d, sin d, 0), d = `direction_deg`, so gravity leans the other way.
/// Exact at multiples of 90 degrees.
Vector3 gravity_on(const Slope& slope);

} // namespace tread::scene
