#pragma once

#include <vector>

#include <Eigen/Core>

#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// Computes the convex hull of points as a closed mesh of their extreme vertices, counter-clockwise seen from outside,
/// by Qhull (Barber, Dobkin & Huhdanpaa 1996, ACM Trans. Math. Softw. 22:469). InputError if the points are coplanar.
TriangleMesh convex_hull(const std::vector<Eigen::Vector3d>& points);

} // namespace tread::shape
