#include "shape/repair/repair.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shape/solids/mass_properties.hpp"
#include "shape/solids/solid.hpp"
#include "unit/shape/awkward_meshes.hpp"
#include "unit/shape/paddle_wheel.hpp"

namespace tread::shape
{
namespace
{

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Repairs, and expects a closed mesh of the given volume.
RepairReport expect_closed(const TriangleMesh& broken, double volume, double tolerance = 1e-12)
{
    const Repaired repaired = repair_mesh(broken);
    EXPECT_EQ(describe_defects(repaired.mesh), "");
    EXPECT_NEAR(mass_properties(repaired.mesh).volume, volume, tolerance);
    return repaired.report;
}

TEST(Repair, LeavesACleanMeshAlone)
{
    const TriangleMesh rock     = rock_mesh({3, 0.7, 0.9, 162}, "rock");
    const Repaired     repaired = repair_mesh(rock);
    ASSERT_EQ(repaired.mesh.triangles.size(), rock.triangles.size());
    EXPECT_EQ(repaired.mesh.vertices.size(), rock.vertices.size());
    for (std::size_t t = 0; t < rock.triangles.size(); ++t)
    {
        for (std::size_t c = 0; c < 3; ++c) { ASSERT_EQ(corner(repaired.mesh, t, c), corner(rock, t, c)); }
    }
    EXPECT_THAT(report_lines(repaired.report), IsEmpty());
}

TEST(Repair, WeldsVerticesThatRoundingParted)
{
    TriangleMesh soup = test::unwelded(test::cube(2));
    for (std::size_t v = 0; v < soup.vertices.size(); ++v)
    {
        soup.vertices[v][static_cast<Eigen::Index>(v % 3)] += v % 2 == 0 ? 5e-7 : -5e-7;
    }
    // Each vertex moves by at most the tolerance of 2e-6: the volume by at most that times the area of 24.
    const RepairReport report = expect_closed(soup, 8, 24 * 2e-6);
    EXPECT_EQ(report.welded_vertices, 36 - 8);
    EXPECT_NEAR(report.tolerance, 2e-6, 1e-11);
}

TEST(Repair, DoesNotWeldWhatIsApart)
{
    // A slit of 2e-5 of the extent stays open.
    const TriangleMesh two =
        test::together(test::box_mesh({0, 0, 0}, {1, 1, 1}), test::box_mesh({1.00002, 0, 0}, {2, 1, 1}));
    EXPECT_EQ(expect_closed(two, 1.99998).welded_vertices, 0);
}

TEST(Repair, DropsDegenerateTriangles)
{
    TriangleMesh mesh = test::cube(1);
    mesh.triangles.push_back({0, 0, 1});
    mesh.vertices.push_back(0.5 * (mesh.vertices[1] + mesh.vertices[5]));
    mesh.triangles.push_back({1, 5, 8});
    EXPECT_EQ(expect_closed(mesh, 1).dropped_degenerate, 2);
}

TEST(Repair, DropsDuplicatesOfEitherWinding)
{
    EXPECT_EQ(expect_closed(test::doubled_faces(), 8).dropped_duplicates, 4);

    TriangleMesh tripled = test::cube(1);
    tripled.triangles.push_back(tripled.triangles[3]);
    tripled.triangles.push_back(tripled.triangles[3]);
    EXPECT_EQ(expect_closed(tripled, 1).dropped_duplicates, 2);

    // Everything twice, as from a program that draws both sides.
    const TriangleMesh twice = test::together(test::cube(1), test::inside_out(test::cube(1)));
    EXPECT_EQ(expect_closed(twice, 1).dropped_duplicates, 12);
}

TEST(Repair, DropsTheWallBetweenPartsThatTouch)
{
    const RepairReport report = expect_closed(test::touching_boxes(), 3);
    EXPECT_EQ(report.dropped_walls, 4);
    EXPECT_EQ(report.dropped_duplicates, 0);
}

TEST(Repair, DividesSeams)
{
    // One side of the cube has an additional vertex on its rim that its neighbours lack.
    TriangleMesh mesh = test::cube(2);
    ASSERT_EQ(mesh.triangles[4], (std::array<std::int32_t, 3>{0, 1, 5}));
    mesh.vertices.emplace_back(0.25, -1, -1);
    mesh.vertices.emplace_back(0.5, -1, -1);
    mesh.triangles[4] = {0, 8, 5};
    mesh.triangles.push_back({8, 9, 5});
    mesh.triangles.push_back({9, 1, 5});
    EXPECT_THAT(describe_defects(mesh), HasSubstr("open edges"));
    EXPECT_EQ(expect_closed(mesh, 8).split_seams, 1);
}

TEST(Repair, WindsTrianglesAlike)
{
    TriangleMesh mesh = rock_mesh({4, 0.7, 0.9, 162}, "rock");
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    {
        std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    }
    // A rock has the volume of the sphere of diameter 1.
    EXPECT_EQ(expect_closed(mesh, test::pi / 6, 1e-9).turned_triangles,
              static_cast<std::int64_t>((mesh.triangles.size() + 2) / 3));
}

TEST(Repair, TurnsWhatIsInsideOut)
{
    EXPECT_EQ(expect_closed(test::inside_out(test::cube(1)), 1).turned_parts, 1);

    const TriangleMesh mixed =
        test::together(test::box_mesh({0, 0, 0}, {1, 1, 1}), test::inside_out(test::box_mesh({3, 0, 0}, {4, 1, 1})));
    EXPECT_EQ(expect_closed(mixed, 2).turned_parts, 1);
}

TEST(Repair, CavitiesKeepTheirSense)
{
    EXPECT_EQ(expect_closed(test::nested_shells(), 8 - 1).cavities, 1);
    // Everything inside out: the shells still face opposite ways.
    const RepairReport whole = expect_closed(test::inside_out(test::nested_shells()), 8 - 1);
    EXPECT_EQ(whole.cavities, 1);
    EXPECT_EQ(whole.turned_parts, 2);
    // A solid within a solid stays one; volumes of closed surfaces add up.
    EXPECT_EQ(expect_closed(test::together(test::cube(2), test::cube(1)), 8 + 1).cavities, 0);
}

TEST(Repair, ParityDecidesWhereTheFileSaysNothing)
{
    // One triangle is wound wrongly, so the file's orientation is not trusted: void in solid, solid in void.
    TriangleMesh mesh = test::together(test::together(test::cube(4), test::cube(2)), test::cube(1));
    std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
    const RepairReport report = expect_closed(mesh, 64 - 8 + 1);
    EXPECT_EQ(report.cavities, 1);
    EXPECT_EQ(report.turned_triangles, 1);
}

void expect_the_drum_is_kept(int paddles)
{
    const test::PaddleWheel wheel{paddles};
    const TriangleMesh      mesh = test::wheel_with_paddles_inside_out(wheel);
    EXPECT_THAT(
        test::input_error([&] { make_solid(mesh, shape::Repair::none, "wheel"); }),
        HasSubstr(std::to_string(paddles) + " of its " + std::to_string(paddles + 1) + " parts are inside out"));
    const RepairReport report = repair_mesh(mesh).report;
    EXPECT_EQ(report.turned_parts, paddles);
    EXPECT_EQ(report.cavities, 0);
    const double measured = make_solid(mesh, shape::Repair::tried, "wheel").unit.volume, expected = test::volume(wheel);
    std::printf("volume with %d paddles: measured %.6f, expected %.6f m3, tolerance 1 %%: the sampling's 0.1 %%, thin "
                "paddles\n",
                paddles, measured, expected);
    EXPECT_NEAR(measured, expected, 0.01 * expected);
}

/// 8 is a divisor of the drum's triangles: every eighth of them lies at a paddle.
TEST(FullSizeRepair, AWheelKeepsItsDrumWhateverTheNumberOfPaddles)
{
    for (const int paddles : {7, 8, 12, 16}) { expect_the_drum_is_kept(paddles); }
}

TEST(Repair, PartsThatCrossHoldNoneOfEachOther)
{
    // A tetrahedron: the middles of its faces are inside the cube, its corners outside.
    const TriangleMesh tetrahedron{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                                   {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
    const RepairReport report = repair_mesh(test::together(test::cube(1.8), test::inside_out(tetrahedron))).report;
    EXPECT_EQ(report.cavities, 0);
    EXPECT_EQ(report.turned_parts, 1);
}

TEST(Repair, ClosesSmallHoles)
{
    TriangleMesh mesh = test::cube(1);
    mesh.triangles.pop_back();
    const RepairReport one = expect_closed(mesh, 1);
    EXPECT_EQ(one.closed_holes, 1);
    EXPECT_EQ(one.hole_triangles, 1);
    mesh.triangles.pop_back();
    EXPECT_EQ(expect_closed(mesh, 1).hole_triangles, 2);
}

/// A fine sphere of radius 1 without the triangles within `radius` of a pole.
TriangleMesh holed_sphere(double radius)
{
    TriangleMesh mesh = icosphere(10242, "sphere");
    std::erase_if(
        mesh.triangles, [&](const std::array<std::int32_t, 3>& triangle)
        { return (mesh.vertices[static_cast<std::size_t>(triangle[0])] - Eigen::Vector3d(0, 0, 1)).norm() < radius; });
    return mesh;
}

TEST(Repair, ClosesAHoleOfManyEdgesOnlyIfItIsSmall)
{
    // A flat lid removes a cap of height r^2/2: pi h^2 (1 - h/3).
    const double       height = 0.5 * 0.08 * 0.08, cap = test::pi * height * height;
    const double       whole = mass_properties(icosphere(10242, "sphere")).volume;
    const RepairReport small = expect_closed(holed_sphere(0.06), whole, cap);
    EXPECT_EQ(small.closed_holes, 1);
    EXPECT_GT(small.hole_triangles, 4);

    const Repaired large = repair_mesh(holed_sphere(0.4));
    EXPECT_EQ(large.report.open_holes, 1);
    EXPECT_THAT(describe_defects(large.mesh), HasSubstr("open edges"));
    EXPECT_THAT(report_lines(large.report), Contains(HasSubstr("1 holes left open")));
}

TEST(Repair, EmptyAndHopelessMeshes)
{
    EXPECT_THAT(repair_mesh({}).mesh.triangles, IsEmpty());
    const TriangleMesh point{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}};
    EXPECT_THAT(repair_mesh(point).mesh.triangles, IsEmpty());
    const TriangleMesh single{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    EXPECT_NO_THROW(repair_mesh(single));
}

} // namespace
} // namespace tread::shape
