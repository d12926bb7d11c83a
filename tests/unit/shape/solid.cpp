#include "shape/solids/solid.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/shape/awkward_meshes.hpp"

namespace tread::shape
{
namespace
{

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<Vector3d> random_points(const Bounds& box, int count)
{
    std::mt19937                           random(11);
    std::uniform_real_distribution<double> unit(-0.1, 1.1);
    std::vector<Vector3d>                  points;
    for (int i = 0; i < count; ++i)
    {
        const double x = unit(random), y = unit(random), z = unit(random);
        points.push_back(box.low + Vector3d(x, y, z).cwiseProduct(box.extent()));
    }
    return points;
}

/// Compares with an exact distance function; `accepted` (m) allows for jagged lines where parts meet.
template<class Exact>
void expect_distance(const Solid& solid, const Exact& exact, double accepted)
{
    const MeshDistance distance = prepare_distance(solid);
    double             largest  = 0;
    int                wrong    = 0;
    const auto         points   = random_points(bounds(solid.surface), 100000);
#pragma omp parallel for reduction(max : largest) reduction(+ : wrong)
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const double measured = signed_distance(distance, points[i]), expected = exact(points[i]);
        largest = std::max(largest, std::abs(measured - expected));
        wrong += (measured < 0) != (expected < 0) ? 1 : 0;
    }
    std::printf("100000 points: largest error %.2e m, accepted %.2e m; %d of wrong sign, expected 0\n", largest,
                accepted, wrong);
    EXPECT_LE(largest, accepted);
    EXPECT_EQ(wrong, 0);
}

double box_distance(const Vector3d& point, const Vector3d& low, const Vector3d& high)
{
    const Vector3d beyond = (low - point).cwiseMax(point - high);
    return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

TEST(Solid, ClosedMeshIsTakenAsItIs)
{
    const Solid solid = make_solid(test::cube(1), Repair::none, "cube");
    EXPECT_EQ(solid.sign, SignRule::pseudonormal);
    EXPECT_THAT(solid.remarks, IsEmpty());
    EXPECT_NEAR(solid.unit.volume, 1, 1e-13);
}

TEST(Solid, NestedShellsHaveAVoid)
{
    const Solid solid = make_solid(test::nested_shells(), Repair::none, "shells");
    EXPECT_EQ(solid.sign, SignRule::pseudonormal);
    EXPECT_NEAR(solid.unit.volume, 7, 1e-12);
    const Vector3d one = Vector3d::Ones();
    expect_distance(
        solid,
        [&](const Vector3d& p)
        { return std::max(box_distance(p, -one, one), -box_distance(p, -0.5 * one, 0.5 * one)); },
        1e-12);
}

TEST(Solid, PartsApartNeedNoRepair)
{
    const Solid solid =
        make_solid(test::together(test::box_mesh({0, 0, 0}, {1, 1, 1}), test::box_mesh({2, 0, 0}, {3, 1, 1})),
                   Repair::none, "two");
    EXPECT_EQ(solid.sign, SignRule::pseudonormal);
    EXPECT_NEAR(solid.unit.volume, 2, 1e-12);
    EXPECT_THAT(solid.remarks, Contains(HasSubstr("2 closed surfaces")));
}

TEST(Solid, OverlappingPartsCountOnce)
{
    const Solid solid = make_solid(test::overlapping_cubes(), Repair::none, "cubes");
    EXPECT_EQ(solid.sign, SignRule::winding_number);
    EXPECT_THAT(solid.remarks, Contains(HasSubstr("encloses itself")));
    // Cubes oblique to the sampling grid: its error is about a 128th of the extent, squared, times the area.
    std::printf("volume: measured %.5f, expected 1.875, tolerance 0.1 %%\n", solid.unit.volume);
    EXPECT_NEAR(solid.unit.volume, 1.875, 1e-3 * 1.875);
    EXPECT_LT((solid.unit.centre - Vector3d::Constant(0.75)).norm(), 1e-3);
    // A cube's 1/6 about its own centre, shifted by d = 1/4 (1, 1, 1): + 2/16; less the common eighth's (1/8)(1/24).
    const double expected = 2 * (1.0 / 6 + 2.0 / 16) - 1.0 / 8 / 24;
    EXPECT_NEAR(solid.unit.inertia(0, 0), expected, 2e-3 * expected);

    const Vector3d one = Vector3d::Ones();
    // Outside, the nearest surface is that of the nearer cube. Inside, seen from the notch where they meet, the union's
    // distance exceeds that of either: there only the sign is known exactly.
    const MeshDistance distance = prepare_distance(solid);
    double             largest  = 0;
    for (const Vector3d& p : random_points(bounds(solid.surface), 20000))
    {
        const double either = std::min(box_distance(p, 0 * one, one), box_distance(p, 0.5 * one, 1.5 * one));
        const double got    = signed_distance(distance, p);
        ASSERT_EQ(got < 0, either < 0);
        if (either > 0) { largest = std::max(largest, std::abs(got - either)); }
        else { ASSERT_LT(got, either + 1.5 / 256); }
    }
    std::printf("largest error outside %.2e m, accepted %.2e m (a piece)\n", largest, 1.5 / 256);
    EXPECT_LT(largest, 1.5 / 256);
    // The corner of one cube in the middle of the other is deep inside: 1/2 from the remaining surface.
    EXPECT_NEAR(signed_distance(distance, Vector3d::Constant(0.75)), -std::sqrt(2.0) / 4, 1.5 / 256);
}

TEST(Solid, TouchingBoxesAreOne)
{
    const auto  exact = [](const Vector3d& p) { return box_distance(p, {-1, 0, 0}, {2, 1, 1}); };
    const Solid apart = make_solid(test::touching_boxes(), Repair::none, "vertices apart");
    EXPECT_EQ(apart.sign, SignRule::winding_number);
    expect_distance(apart, exact, 1e-12);
    const Solid repaired = make_solid(test::touching_boxes(), Repair::tried, "wall dropped");
    EXPECT_EQ(repaired.sign, SignRule::pseudonormal);
    expect_distance(repaired, exact, 1e-12);
}

/// Distance to the surface of the boxes (-1, 0, 0) to (0, 1, 1) and (0, 1/4, 1/4) to (1, 3/4, 3/4), which touch at x =
/// 0.
double peg_distance(const Vector3d& p)
{
    const double one = box_distance(p, {-1, 0, 0}, {0, 1, 1});
    const double two = box_distance(p, {0, 0.25, 0.25}, {1, 0.75, 0.75});
    if (one > 0 && two > 0) { return std::min(one, two); }
    // Inside, the wall is not surface; the nearest point of its plane's remaining surface is on its rim.
    const double into = std::min({p.y() - 0.25, 0.75 - p.y(), p.z() - 0.25, 0.75 - p.z()});
    if (two <= 0) { return -std::min(into, 1 - p.x()); }
    const double others = std::min({p.x() + 1, p.y(), 1 - p.y(), p.z(), 1 - p.z()});
    return -std::min(others, std::hypot(p.x(), std::max(into, 0.0)));
}

TEST(Solid, PartsThatTouchInAPartOfAFace)
{
    const TriangleMesh mesh =
        test::together(test::box_mesh({-1, 0, 0}, {0, 1, 1}), test::box_mesh({0, 0.25, 0.25}, {1, 0.75, 0.75}));
    for (const Repair repair : {Repair::none, Repair::tried})
    {
        const Solid solid = make_solid(mesh, repair, "peg");
        EXPECT_EQ(solid.sign, SignRule::winding_number);
        EXPECT_NEAR(solid.unit.volume, 1.25, 1.25e-3);
        // The rim of the wall is jagged to the length of a piece, a 256th of the extent of 2.
        expect_distance(solid, peg_distance, 2.0 / 256);
    }
}

TEST(Solid, RefusesDefectsAndSaysWhatWouldHelp)
{
    const std::string message =
        test::input_error([] { make_solid(test::doubled_faces(), Repair::none, "shape 'part', file part.stl"); });
    EXPECT_THAT(message, AllOf(HasSubstr("part.stl"), HasSubstr("non-manifold edges"), HasSubstr("the first at"),
                               HasSubstr("repair = true")));
    const Solid repaired = make_solid(test::doubled_faces(), Repair::tried, "part");
    EXPECT_EQ(repaired.sign, SignRule::pseudonormal);
    const Vector3d one = Vector3d::Ones();
    expect_distance(
        repaired, [&](const Vector3d& p) { return box_distance(p, -one, one); }, 1e-12);
}

TEST(Solid, RefusesAPartThatIsInsideOut)
{
    const TriangleMesh mesh =
        test::together(test::cube(1), test::inside_out(test::box_mesh({2, 0, 0}, {2.5, 0.5, 0.5})));
    EXPECT_THAT(test::input_error([&] { make_solid(mesh, Repair::none, "two"); }),
                AllOf(HasSubstr("1 of its 2 parts are inside out"), HasSubstr("repair = true")));
    EXPECT_NEAR(make_solid(mesh, Repair::tried, "two").unit.volume, 1.125, 1e-12);
}

TEST(Solid, LargeHolesAreSignedByWindingNumber)
{
    TriangleMesh mesh = icosphere(642, "sphere");
    std::erase_if(mesh.triangles,
                  [&](const auto& t) { return mesh.vertices[static_cast<std::size_t>(t[0])].z() > 0.9; });
    const Solid solid = make_solid(mesh, Repair::tried, "bowl");
    EXPECT_EQ(solid.sign, SignRule::winding_number);
    EXPECT_THAT(solid.remarks, Contains(HasSubstr("still not closed")));
    // The surface with winding number 1/2 over the hole lies between the cap and the plane of its rim, which removes pi
    // h^2 (1 - h/3); the rim is an edge of 0.16 down the slope from z = 0.9, h = 0.1 + 0.16 sin(26 deg) = 0.17.
    const double whole = mass_properties(icosphere(642, "sphere")).volume,
                 cap   = test::pi * 0.17 * 0.17 * (1 - 0.17 / 3);
    std::printf("volume: measured %.4f, expected %.4f to %.4f\n", solid.unit.volume, whole - cap, whole);
    EXPECT_GT(solid.unit.volume, whole - cap);
    EXPECT_LT(solid.unit.volume, whole);
}

/// Six spheres that share most of their volume, in places three of them.
TEST(FullSizeSolid, PartsThatShareMostOfTheirVolumeAreTaken)
{
    TriangleMesh rock;
    for (int i = 0; i < 4; ++i)
    {
        TriangleMesh sphere = icosphere(42, "sphere");
        for (Vector3d& vertex : sphere.vertices) { vertex += 0.2 * test::sphere_point(i, 4); }
        rock = test::together(rock, sphere);
    }
    const double one   = mass_properties(icosphere(42, "sphere")).volume;
    const Solid  solid = make_solid(rock, Repair::tried, "rock");
    EXPECT_GT(solid.unit.volume, one);
    EXPECT_LT(solid.unit.volume, 2 * one);
}

/// A bar whose far half is turned about its axis, so that this half faces inwards: 0.6 m of it count +, 0.4 m count -.
TEST(Solid, RefusesAVolumeThatIsNotThatOfItsParts)
{
    TriangleMesh bar = test::box_mesh({0, -0.5, -0.5}, {1, 0.5, 0.5});
    for (Vector3d& vertex : bar.vertices)
    {
        if (vertex.x() > 0.5) { vertex.y() *= -0.8; }
    }
    for (const Repair repair : {Repair::none, Repair::tried})
    {
        EXPECT_THAT(test::input_error([&] { make_solid(bar, repair, "bar"); }),
                    AllOf(HasSubstr("bar: the solid would have 0."),
                          HasSubstr("by their own volumes: 1 solid parts hold"), HasSubstr("0 cavities"),
                          HasSubstr("20 %")));
    }
}

TEST(Solid, RefusesWhatEnclosesNothing)
{
    const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0.1}}, {{0, 1, 4}, {1, 2, 4}}};
    EXPECT_THAT(test::input_error([&] { make_solid(sheet, Repair::tried, "sheet"); }), HasSubstr("encloses no"));
}

} // namespace
} // namespace tread::shape
