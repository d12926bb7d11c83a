#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "unit/shape/awkward_meshes.hpp"

// A wheel as assembled in a drawing program: a solid drum with paddles that penetrate it.
namespace tread::test
{

/// Axle along y; m.
struct PaddleWheel
{
    int    paddles;
    double radius = 0.1, width = 0.12; ///< of the drum
    double foot = 0.095, tip = 0.14;   ///< of the paddles, from the axle
    double thickness = 0.006;          ///< of the paddles
    int    sides     = 96;             ///< of the drum
};

inline shape::TriangleMesh drum_mesh(const PaddleWheel& wheel)
{
    shape::TriangleMesh mesh;
    const double        half = 0.5 * wheel.width;
    mesh.vertices            = {{0, -half, 0}, {0, half, 0}};
    for (int i = 0; i < wheel.sides; ++i)
    {
        const double angle = 2 * pi * i / wheel.sides, x = wheel.radius * std::cos(angle),
                     z = wheel.radius * std::sin(angle);
        mesh.vertices.emplace_back(x, -half, z);
        mesh.vertices.emplace_back(x, half, z);
    }
    for (int i = 0; i < wheel.sides; ++i)
    {
        const int a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % wheel.sides);
        mesh.triangles.push_back({a, a + 1, b + 1});
        mesh.triangles.push_back({a, b + 1, b});
        mesh.triangles.push_back({0, a, b});
        mesh.triangles.push_back({1, b + 1, a + 1});
    }
    return mesh;
}

inline shape::TriangleMesh paddle_mesh(const PaddleWheel& wheel, int which)
{
    const double half = 0.5 * wheel.thickness, angle = 2 * pi * which / wheel.paddles;
    auto         mesh = box_mesh({wheel.foot, -0.5 * wheel.width, -half}, {wheel.tip, 0.5 * wheel.width, half});
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex = turn * vertex; }
    return mesh;
}

/// Wheel whose drum triangles face outwards and paddle triangles inwards.
inline shape::TriangleMesh wheel_with_paddles_inside_out(const PaddleWheel& wheel)
{
    shape::TriangleMesh mesh = drum_mesh(wheel);
    for (int i = 0; i < wheel.paddles; ++i) { mesh = together(mesh, inside_out(paddle_mesh(wheel, i))); }
    return mesh;
}

/// Volume, m3: the drum is a prism of `sides` triangles; paddles count beyond the circle (the drum's polygon is within
/// 0.06 mm of it).
inline double volume(const PaddleWheel& wheel)
{
    const double r = wheel.radius, t = 0.5 * wheel.thickness;
    const double drum   = 0.5 * wheel.sides * r * r * std::sin(2 * pi / wheel.sides);
    const double in_rim = t * std::sqrt(r * r - t * t) + r * r * std::asin(t / r); // from the axle to the circle
    return wheel.width * (drum + wheel.paddles * (wheel.tip * wheel.thickness - in_rim));
}

} // namespace tread::test
