#pragma once

#include <vector>

#include <Eigen/Core>

#include "shape/mesh.hpp"

namespace tread::shape
{

/// The convex hull of points in space as a closed mesh of its own vertices, counter-clockwise seen from outside, by
/// Qhull (Barber, Dobkin & Huhdanpaa 1996, ACM Trans. Math. Softw. 22:469). InputError if the points lie in a plane.
TriangleMesh convex_hull(const std::vector<Eigen::Vector3d>& points);

} // namespace tread::shape
