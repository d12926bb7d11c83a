#pragma once

#include <vector>

#include <Eigen/Core>

#include "shape/mesh.hpp"

namespace tread::shape
{

/// m, how far the deepest of `places` on the surface of the mesh lies below the mesh's convex hull: 0 of a convex one.
double hull_depth(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& places);

} // namespace tread::shape
