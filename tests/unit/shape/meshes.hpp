#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "shape/generators/generators.hpp"
#include "shape/mesh/mesh.hpp"
#include "shape/mesh/triangle.hpp"

// Meshes with known properties.
namespace tread::test
{

constexpr double pi = 3.14159265358979323846;

/// Axis-aligned box from `low` to `high`, two triangles per side.
inline shape::TriangleMesh box_mesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high)
{
    shape::TriangleMesh mesh;
    for (int c = 0; c < 8; ++c)
    {
        mesh.vertices.emplace_back(c & 1 ? high.x() : low.x(), c & 2 ? high.y() : low.y(), c & 4 ? high.z() : low.z());
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

inline shape::TriangleMesh cube(double edge)
{
    return box_mesh(Eigen::Vector3d::Constant(-0.5 * edge), Eigen::Vector3d::Constant(0.5 * edge));
}

/// Ellipsoid with vertices exactly on it.
inline shape::TriangleMesh ellipsoid(const Eigen::Vector3d& half_axes, int nodes)
{
    shape::TriangleMesh mesh = shape::icosphere(nodes, "ellipsoid");
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex = vertex.cwiseProduct(half_axes); }
    return mesh;
}

/// Point i of `count` points distributed evenly on the unit sphere (Fibonacci lattice).
inline Eigen::Vector3d sphere_point(int i, int count)
{
    const double height = 1 - (2.0 * i + 1) / count;
    const double turn   = i * pi * (3 - std::sqrt(5.0));
    const double reach  = std::sqrt(1 - height * height);
    return {reach * std::cos(turn), reach * std::sin(turn), height};
}

/// Winding number of the surface about the point: 1 inside, 0 outside, whatever triangle is closest. Solid angles after
/// Van Oosterom & Strackee 1983, IEEE Trans. Biomed. Eng. 30:125.
inline double winding_number(const shape::TriangleMesh& mesh, const Eigen::Vector3d& point)
{
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        const Eigen::Vector3d a = shape::corner(mesh, t, 0) - point;
        const Eigen::Vector3d b = shape::corner(mesh, t, 1) - point;
        const Eigen::Vector3d c = shape::corner(mesh, t, 2) - point;
        const double          x = a.norm(), y = b.norm(), z = c.norm();
        sum += 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
    }
    return sum / (4 * pi);
}

/// Runs f, which must throw InputError, and returns its message.
template<class F>
std::string input_error(F f)
{
    try
    {
        f();
    }
    catch (const InputError& error)
    {
        return error.what();
    }
    ADD_FAILURE() << "no InputError was thrown";
    return {};
}

} // namespace tread::test
