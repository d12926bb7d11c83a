#pragma once

#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "shape/mesh.hpp"

// Sizes and directions of the triangles of a mesh.
namespace tread::shape
{

inline const Eigen::Vector3d& corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t which)
{
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][which])];
}

/// Normal times twice the area, m2.
inline Eigen::Vector3d area_vector(const TriangleMesh& mesh, std::size_t triangle)
{
    const Eigen::Vector3d& a = corner(mesh, triangle, 0);
    return (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a);
}

/// m2, of the whole surface.
inline double surface_area(const TriangleMesh& mesh)
{
    double twice = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) { twice += area_vector(mesh, t).norm(); }
    return 0.5 * twice;
}

} // namespace tread::shape
