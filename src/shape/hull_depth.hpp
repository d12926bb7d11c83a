#pragma once

#include <vector>

#include <Eigen/Core>

#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// Depth (m) of the deepest of `places` on the mesh's surface below the mesh's convex hull: 0 for a convex mesh.
double hull_depth(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& places);

} // namespace tread::shape
