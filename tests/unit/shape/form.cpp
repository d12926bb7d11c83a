#include "shape/generators/form.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shape/mesh/convex_hull.hpp"
#include "shape/solids/mass_properties.hpp"
#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

using ::testing::HasSubstr;

TriangleMesh turned(TriangleMesh mesh, double scale)
{
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).matrix();
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex = scale * (turn * vertex) + Eigen::Vector3d(5, -3, 2); }
    return mesh;
}

void expect_form(const char* name, const TriangleMesh& mesh, const Form& expected, double tolerance, const char* why)
{
    const Form found = form_of(mesh);
    std::printf("%s: measured %.6f %.6f %.6f %.6f, expected %.6f %.6f %.6f %.6f, tolerance %.1e: %s\n", name,
                found.aspect, found.elongation, found.sphericity, found.solidity, expected.aspect, expected.elongation,
                expected.sphericity, expected.solidity, tolerance, why);
    EXPECT_NEAR(found.aspect, expected.aspect, tolerance);
    EXPECT_NEAR(found.elongation, expected.elongation, tolerance);
    EXPECT_NEAR(found.sphericity, expected.sphericity, tolerance);
    EXPECT_NEAR(found.solidity, expected.solidity, tolerance);
}

TEST(Form, OfABoxHoweverItLies)
{
    const TriangleMesh box  = test::box_mesh({0, 0, 0}, {3, 2, 1.5});
    const double       ball = std::cbrt(test::pi) * std::pow(6 * 9.0, 2.0 / 3.0);
    const Form         expected{0.5, 2.0 / 3.0, ball / 27.0, 1};
    expect_form("box", box, expected, 1e-6, "what extents promises");
    expect_form("turned box", turned(box, 0.01), expected, 1e-6, "what extents promises");
}

TEST(Form, OfAnEllipsoid)
{
    // Wadell's sphericity of 1 : 0.775 : 0.55, surface by the formula with elliptic integrals: 0.95265.
    // 10242 vertices: chords take 4e-4 of a length, and less of a ratio.
    expect_form("ellipsoid", turned(test::ellipsoid({1, 0.775, 0.55}, 10242), 3), {0.55, 0.775, 0.9527, 1}, 1e-3,
                "facets of the mesh");
}

TEST(Form, OfARegularTetrahedronIsThatOfItsCube)
{
    // Tetrahedron on every other corner of a cube. Its smallest width is between opposite edges, along the cube's axes
    // (a face and the opposite corner are 2/sqrt(3) cube edges apart), and so is that of its silhouette, a square.
    const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}},
                                   {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
    const double       sphericity = std::cbrt(test::pi) * std::pow(2.0, 2.0 / 3.0) / (2 * std::sqrt(3.0));
    expect_form("tetrahedron", turned(tetrahedron, 1), {1, 1, sphericity, 1}, 1e-6, "what extents promises");
}

TEST(Form, SolidityIsWhatTheHullAddsToAStar)
{
    // A cube with a pyramid of half its height removed from the top: 1 - 1/6 of its hull, the cube.
    TriangleMesh notched = test::cube(1);
    notched.triangles.erase(notched.triangles.begin() + 2, notched.triangles.begin() + 4);
    notched.vertices.emplace_back(0, 0, 0);
    for (const auto& side : {std::array{4, 5}, {5, 7}, {7, 6}, {6, 4}})
    {
        notched.triangles.push_back({side[0], side[1], 8});
    }
    ASSERT_NO_THROW(require_watertight(notched, "notched cube"));
    EXPECT_NEAR(form_of(notched).solidity, 5.0 / 6.0, 1e-12);
}

TEST(ConvexHull, OfPointsInAndOnABoxIsTheBox)
{
    std::vector<Eigen::Vector3d> points = test::box_mesh({0, 0, 0}, {3, 2, 1}).vertices;
    for (int i = 0; i < 50; ++i) { points.push_back(Eigen::Vector3d(1.5, 1, 0.5) + 0.5 * test::sphere_point(i, 50)); }
    const TriangleMesh hull = convex_hull(points);
    EXPECT_NO_THROW(require_watertight(hull, "hull"));
    EXPECT_EQ(hull.vertices.size(), 8u);
    EXPECT_NEAR(mass_properties(hull).volume, 6, 1e-12);
}

TEST(ConvexHull, RefusesAPlane)
{
    EXPECT_THAT(test::input_error(
                    [] {
                        convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 2, 0}});
                    }),
                HasSubstr("5 points lie in a plane"));
}

TEST(FormTable, AddsMeanLeastAndMostToSeveral)
{
    EXPECT_THAT(form_table({{"a", {0.5, 0.7, 0.9, 1}}}), ::testing::Not(HasSubstr("mean")));
    const std::string table = form_table({{"a", {0.5, 0.7, 0.9, 1}}, {"b", {0.6, 0.7, 0.8, 0.9}}});
    EXPECT_THAT(table, HasSubstr("mean              0.550      0.700      0.850    0.950\n"));
    EXPECT_THAT(table, HasSubstr("least             0.500      0.700      0.800    0.900\n"));
    EXPECT_THAT(table, HasSubstr("most              0.600      0.700      0.900    1.000\n"));
}

} // namespace
} // namespace tread::shape
