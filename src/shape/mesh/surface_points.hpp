#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

struct SurfacePoint
{
    Eigen::Vector3d position;
    Eigen::Vector3d normal; ///< unit, outwards
    std::int32_t    triangle;
};

/// `count` points distributed evenly by area: triangles before the i-th point cover (i + 1/2)/count of the surface;
/// within the triangle, points follow the additive sequence of the plastic number (Roberts 2018), folded in half. The
/// same on every machine.
std::vector<SurfacePoint> points_on(const TriangleMesh& mesh, std::size_t count);

} // namespace tread::shape
