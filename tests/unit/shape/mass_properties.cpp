#include "shape/solids/mass_properties.hpp"

#include <gtest/gtest.h>

#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

double relative_error(const Matrix3d& measured, const Matrix3d& expected)
{
    return (measured - expected).norm() / expected.norm();
}

// Polyhedra are exact up to rounding.
constexpr double rounding = 1e-13;

TEST(MassProperties, CubeIsExact)
{
    const MassProperties measured = mass_properties(test::cube(0.4));
    const double         volume   = 0.4 * 0.4 * 0.4;
    EXPECT_NEAR(measured.volume, volume, rounding * volume);
    EXPECT_LT(measured.centre.norm(), rounding);
    EXPECT_LT(relative_error(measured.inertia, volume * 0.16 / 6 * Matrix3d::Identity()), rounding);
}

TEST(MassProperties, TetrahedronIsExact)
{
    const TriangleMesh   tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    const MassProperties measured = mass_properties(tetrahedron);
    // int x^2 = 1/60 and int x y = 1/120 about the corner, moved to the centre (1, 1, 1)/4.
    Matrix3d expected = Matrix3d::Constant(1.0 / 480);
    expected.diagonal().setConstant(1.0 / 80);
    EXPECT_NEAR(measured.volume, 1.0 / 6, rounding);
    EXPECT_LT((measured.centre - Vector3d::Constant(0.25)).norm(), rounding);
    EXPECT_LT(relative_error(measured.inertia, expected), rounding);
}

TEST(MassProperties, FollowsShiftAndRotation)
{
    const TriangleMesh   mesh  = rock_mesh({3, 0.6, 0.88}, "rock");
    const MassProperties here  = mass_properties(mesh);
    const Matrix3d       turn  = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Vector3d       shift = Vector3d(10, -20, 5);
    TriangleMesh         moved = mesh;
    for (Vector3d& vertex : moved.vertices) { vertex = turn * vertex + shift; }
    const MassProperties there = mass_properties(moved);

    // Coordinates of 23 m are rounded to 4e-15 m, for a size of 1 m.
    EXPECT_NEAR(there.volume, here.volume, 1e-12);
    EXPECT_LT((there.centre - (turn * here.centre + shift)).norm(), 1e-12);
    EXPECT_LT(relative_error(there.inertia, turn * here.inertia * turn.transpose()), 1e-12);
}

TEST(MassProperties, EllipsoidConvergesWithTheSquareOfTheEdge)
{
    const Vector3d half_axes(1, 0.775, 0.55);
    const double   volume  = 4 * test::pi / 3 * half_axes.prod();
    const Vector3d squares = half_axes.cwiseAbs2();
    const Matrix3d inertia = volume / 5 * Vector3d(squares.sum() * Vector3d::Ones() - squares).asDiagonal();

    const MassProperties coarse       = mass_properties(test::ellipsoid(half_axes, 642));
    const MassProperties fine         = mass_properties(test::ellipsoid(half_axes, 2562));
    const double         coarse_error = 1 - coarse.volume / volume, fine_error = 1 - fine.volume / volume;
    std::printf("volume error: 642 nodes %.3e, 2562 nodes %.3e, ratio %.3f (expected 4)\n", coarse_error, fine_error,
                coarse_error / fine_error);
    // A facet lies within its edge^2/8R of the surface: edge 0.08 R gives less than 0.3 % of the volume.
    EXPECT_GT(fine_error, 0);
    EXPECT_LT(fine_error, 3e-3);
    EXPECT_NEAR(coarse_error / fine_error, 4, 0.1);
    EXPECT_LT(relative_error(fine.inertia, inertia), 5.0 / 3 * 3e-3);
    EXPECT_NEAR(relative_error(coarse.inertia, inertia) / relative_error(fine.inertia, inertia), 4, 0.1);
}

} // namespace
} // namespace tread::shape
