#pragma once

#include "decomp/decomposition.hpp"
#include "kernels/mpm/points.hpp"
#include "world/host_points.hpp"

namespace tread::solver
{

/// Copies points to a backend, as planes.
template<class Exec, class Real>
void upload_points(mpm::Points<Exec, Real>& points, const world::HostPoints& host, mpm::PointFields fields);

/// Makes the points of the pages that this rank owns.
template<class Exec>
world::HostPoints own_points(const scene::Scene& scene, const world::World& world,
                             const decomp::Decomposition<Exec>& decomposition);

} // namespace tread::solver
