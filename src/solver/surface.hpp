#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "solver/recorder.hpp"

// How high the terrain stands.
namespace tread::solver
{

/// Of each column of cells the height of its highest point, m.
using SurfaceColumns = std::map<std::pair<long, long>, double>;

SurfaceColumns surface_columns(const std::vector<Vec3<double>>& positions, double spacing);

/// Collective: of all ranks' columns.
SurfaceColumns gathered(const SurfaceColumns& columns, const Communicator& communicator);

/// m, the median of the columns away from the bodies.
double middle_height(const SurfaceColumns& columns, const std::vector<BodyRow>& bodies, double spacing);

} // namespace tread::solver
