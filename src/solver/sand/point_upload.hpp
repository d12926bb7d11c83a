#pragma once

#include "decomp/decomposition.hpp"
#include "kernels/mpm/points.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Copies the points of a world to a backend, as planes.
template<class Exec, class Real>
void upload_points(mpm::Points<Exec, Real>& points, const world::HostPoints& host, mpm::PointFields fields);

/// Copies the points of the pages that this rank owns, with their ids, from points of all ranks.
template<class Exec>
world::HostPoints own_points(const world::World& world, const decomp::Decomposition<Exec>& decomposition);

} // namespace tread::solver
