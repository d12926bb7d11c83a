#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "shape/mesh/mesh.hpp"

// Areas and normals of the triangles of a mesh.
namespace tread::shape
{

inline const Eigen::Vector3d& corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t which)
{
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][which])];
}

using Corners = std::array<Eigen::Vector3d, 3>;

inline Corners corners(const TriangleMesh& mesh, std::size_t triangle)
{
    return {corner(mesh, triangle, 0), corner(mesh, triangle, 1), corner(mesh, triangle, 2)};
}

inline Bounds bounds(const Corners& triangle)
{
    return {triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]),
            triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2])};
}

/// Unit normal times twice the area, m2.
inline Eigen::Vector3d area_vector(const TriangleMesh& mesh, std::size_t triangle)
{
    const Eigen::Vector3d& a = corner(mesh, triangle, 0);
    return (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a);
}

/// Angle (rad) of a triangle at one of its corners.
inline double angle_at(const TriangleMesh& mesh, std::size_t triangle, std::size_t which)
{
    const Eigen::Vector3d& apex  = corner(mesh, triangle, which);
    const Eigen::Vector3d  left  = corner(mesh, triangle, (which + 1) % 3) - apex;
    const Eigen::Vector3d  right = corner(mesh, triangle, (which + 2) % 3) - apex;
    return std::atan2(left.cross(right).norm(), left.dot(right));
}

/// Whether the triangle has no usable normal: single-precision corners locate the height of a sliver to some 1e-7 of
/// its length, and below 1e-8 nothing is left of it.
inline bool is_degenerate(const TriangleMesh& mesh, std::size_t triangle)
{
    constexpr double       least_height = 1e-8;
    const Eigen::Vector3d &a = corner(mesh, triangle, 0), &b = corner(mesh, triangle, 1),
                          &c = corner(mesh, triangle, 2);
    const double longest     = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return !(area_vector(mesh, triangle).norm() > least_height * longest);
}

/// Area (m2) of the whole surface.
inline double surface_area(const TriangleMesh& mesh)
{
    double twice = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) { twice += area_vector(mesh, t).norm(); }
    return 0.5 * twice;
}

} // namespace tread::shape
