#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "io/snapshot.hpp"
#include "solver/recorder.hpp"
#include "solver/world.hpp"

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

/// m, the same of a bed of rocks, of which there is at least one: in columns of two mean diameters, each as high as the
/// sphere of equal volume of its highest rock. `fields`: of all bodies.
double height_of_rocks(const World& world, const io::BodyFields& fields, const std::vector<BodyRow>& bodies);

} // namespace tread::solver
