#pragma once

#include <string>
#include <vector>

#include "kernels/mpm/pages/order.hpp"
#include "solver/state_file.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Saves the fields of points to the data sets `folder`/FIELD_COMPONENT of a checkpoint, or loads them; each rank its
/// own, or an even share of all where the state is not exact. Fields that never change are restored from `built` by id.
/// `seen`: [points of the scene], ids loaded so far; an id that comes twice is refused.
template<class Exec, class Real>
void transfer_points(StateFile& file, mpm::Points<Exec, Real>& points, const std::string& folder,
                     const mpm::GridGeometry& geometry, const world::Sand& built, std::vector<bool>& seen);

} // namespace tread::solver
