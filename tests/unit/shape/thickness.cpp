#include "shape/mesh/thickness.hpp"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "shape/distance/template_sdf.hpp"
#include "shape/mesh/surface_points.hpp"
#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace thickness_test
{

using Eigen::Vector3d;

double thickness_of(const TriangleMesh& mesh) { return thinnest_wall(mesh, build_tree(mesh)); }

void expect_thickness(const char* what, double measured, double expected, double tolerance)
{
    std::printf("%s: thinnest wall measured %.5g m, expected %.5g m, tolerance %.2g m\n", what, measured, expected,
                tolerance);
    EXPECT_NEAR(measured, expected, tolerance) << what;
}

TEST(Thickness, OfABoxIsItsShortestSide)
{
    expect_thickness("plate", thickness_of(test::box_mesh({0, 0, 0}, {1, 0.7, 0.03})), 0.03, 1e-12);
    expect_thickness("cube", thickness_of(test::cube(0.5)), 0.5, 1e-12);
}

TEST(Thickness, OfABallIsItsDiameter)
{
    // Chords between facets are shorter than the diameter by the faceting, (edge/2)^2/R = 0.9 % at both ends with 642
    // nodes.
    expect_thickness("ball", thickness_of(test::ellipsoid(Vector3d::Ones(), 642)), 2, 0.02);
}

TEST(Thickness, OfAWheelIsItsGrousersOrItsWall)
{
    const auto wheel = [](double grouser_width) {
        return wheel_mesh({0.26, 0.33, 0.01, 48, 0.0125, grouser_width}, "wheel");
    };
    // A grouser with parallel sides; the wall's chord between its facets is short by R (1 - cos(pi/facets)) at most.
    expect_thickness("grousers of 4 mm", thickness_of(wheel(0.004)), 0.004, 1e-5);
    expect_thickness("wall of 10 mm", thickness_of(wheel(0.012)), 0.01, 5e-4);
}

TEST(Thickness, ASharpEdgeIsNoWall)
{
    TriangleMesh corner;
    corner.vertices  = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)};
    corner.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const int cells  = cells_for_wall(bounds(corner), thickness_of(corner));
    std::printf("corner of a cube: measured %d cells, expected the least, 40\n", cells);
    EXPECT_EQ(cells, 40);
}

TEST(Thickness, CellsKeepOneAndAHalfAcrossAWall)
{
    const Bounds box{Vector3d::Zero(), Vector3d(0.52, 0.33, 0.52)};
    EXPECT_EQ(cells_for_wall(box, 0.004), 234); // 1.2 x 0.52 x 1.5 / 0.004
    EXPECT_EQ(cells_for_wall(box, 0.2), 40);
    EXPECT_EQ(cells_for_wall(box, std::numeric_limits<double>::infinity()), 40);
}

TEST(Rays, MeetTheSphereWhereTheyShould)
{
    const TriangleMesh mesh = test::ellipsoid(Vector3d::Ones(), 2562);
    const TriangleTree tree = build_tree(mesh);
    Random             random(1);
    double             worst = 0;
    for (int i = 0; i < 2000; ++i)
    {
        const Vector3d origin(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
        const Vector3d direction = test::sphere_point(i, 2000);
        const double   along     = origin.dot(direction);
        const double   expected  = -along + std::sqrt(along * along + 1 - origin.squaredNorm());
        const RayHit   hit       = first_hit(tree, origin, direction, -1);
        ASSERT_GE(hit.triangle, 0);
        worst = std::max(worst, std::abs(hit.distance - expected));
        EXPECT_EQ(first_hit(tree, origin + 4 * direction, direction, -1).triangle, -1);
    }
    std::printf("rays out of a sphere: off by at most %.2e m, tolerance 4e-3 (facets, aslant by up to 60 degrees)\n",
                worst);
    EXPECT_LT(worst, 4e-3);
}

TEST(Rays, RunAlongTheAxesThroughTheFacesOfBoxes)
{
    const TriangleMesh mesh = test::box_mesh({0, 0, 0}, {1, 1, 1});
    const TriangleTree tree = build_tree(mesh);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        const Vector3d from = Vector3d(0.3, 0.3, 0.3) - 2 * Vector3d::Unit(axis);
        EXPECT_NEAR(first_hit(tree, from, Vector3d::Unit(axis), -1).distance, 1.7, 1e-15);
        EXPECT_EQ(first_hit(tree, from, -Vector3d::Unit(axis), -1).triangle, -1);
    }
}

TEST(SurfacePoints, AreSpreadByArea)
{
    const TriangleMesh mesh   = test::box_mesh({0, 0, 0}, {1, 2, 4});
    const auto         points = points_on(mesh, 2800);
    ASSERT_EQ(points.size(), 2800u);
    int on_top = 0, in_lower_half = 0;
    for (const SurfacePoint& point : points)
    {
        EXPECT_LT(std::abs(point.normal.norm() - 1), 1e-12);
        on_top += point.normal.z() > 0.5 ? 1 : 0;
        in_lower_half += point.position.y() < 1 ? 1 : 0;
    }
    // Whole sides: their share of 28 m2, to a point per triangle; parts of sides: a sequence with a discrepancy of
    // about 1/n.
    std::printf("points on the top: %d, expected 200, tolerance 2; in half the box: %d, expected 1400, tolerance 20\n",
                on_top, in_lower_half);
    EXPECT_NEAR(on_top, 200, 2);
    EXPECT_NEAR(in_lower_half, 1400, 20);
}

} // namespace thickness_test
} // namespace tread::shape
