#include "shape/generators.hpp"

#include <cmath>
#include <cstddef>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shape/mass_properties.hpp"
#include "shape/mesh_distance.hpp"
#include "shape/template.hpp"
#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

using ::testing::HasSubstr;

scene::WheelGenerator builtin_wheel(const std::string& name)
{
    return std::get<scene::WheelGenerator>(find_shape(scene::Scene{}, name).source);
}

TEST(Icosphere, HasItsVerticesOnTheSphere)
{
    for (const int nodes : {42, 162, 642, 2562})
    {
        const TriangleMesh mesh = icosphere(nodes, "sphere");
        EXPECT_EQ(mesh.vertices.size(), static_cast<std::size_t>(nodes));
        EXPECT_NO_THROW(require_watertight(mesh, "sphere"));
        for (const auto& vertex : mesh.vertices) { EXPECT_NEAR(vertex.norm(), 1, 1e-15); }
    }
    EXPECT_THAT(test::input_error([] { icosphere(100, "shape 'x'"); }), HasSubstr("shape 'x': nodes = 100"));
}

TEST(Rock, MeetsItsAspectSphericityAndVolume)
{
    for (std::uint64_t seed = 0; seed < 40; ++seed)
    {
        for (const int nodes : {42, 162, 642})
        {
            const TriangleMesh mesh = rock_mesh({seed, 0.75, 0.90, nodes}, "rock");
            ASSERT_NO_THROW(require_watertight(mesh, "rock"));
            ASSERT_NEAR(sphericity(mesh), 0.90, 0.03 * 0.90) << "seed " << seed << ", " << nodes << " nodes";
            ASSERT_NEAR(mass_properties(mesh).volume, test::pi / 6, 1e-12);
            const Eigen::Vector3d extent = bounds(mesh).extent();
            ASSERT_NEAR(extent.z() / extent.x(), 0.75, 1e-12);
            ASSERT_NEAR(extent.y() / extent.x(), 0.875, 1e-12);
        }
    }
}

TEST(Rock, IsTheSameForTheSameSeedAndAnotherForAnother)
{
    const TriangleMesh one = rock_mesh({7, 0.55, 0.90, 162}, "rock"), again = rock_mesh({7, 0.55, 0.90, 162}, "rock"),
                       other = rock_mesh({8, 0.55, 0.90, 162}, "rock");
    EXPECT_EQ(one.vertices, again.vertices);
    double most = 0;
    for (std::size_t i = 0; i < one.vertices.size(); ++i)
    {
        most = std::max(most, (one.vertices[i] - other.vertices[i]).norm());
    }
    EXPECT_GT(most, 0.02);
}

TEST(Rock, SaysWhatSphericityCanBeReached)
{
    const std::string message = test::input_error([] { rock_mesh({1, 0.4, 0.99, 162}, "shape 'flat'"); });
    EXPECT_THAT(message, HasSubstr("shape 'flat': sphericity = 0.99"));
    // That of the ellipsoid 1 : 0.7 : 0.4 with 162 nodes.
    EXPECT_THAT(message, HasSubstr("to 0.889 can be reached"));
    test::input_error([] { rock_mesh({1, 0.1, 0.9, 162}, "rock"); });
    test::input_error([] { rock_mesh({1, 0.5, 1.1, 162}, "rock"); });
    test::input_error([] { rock_mesh({1, 0.5, 0.9, 100}, "rock"); });
}

TEST(Wheel, IsWatertightWithTheVolumeOfItsProfile)
{
    for (const std::string& name : builtin_shape_names())
    {
        const scene::WheelGenerator g    = builtin_wheel(name);
        const TriangleMesh          mesh = wheel_mesh(g, name);
        ASSERT_NO_THROW(require_watertight(mesh, name));
        const double drum  = g.radius - g.grouser_height;
        const double inner = drum - g.wall_thickness;
        const double expected =
            (test::pi * (drum * drum - inner * inner) + g.grousers * g.grouser_height * g.grouser_width) * g.width;
        const double measured = mass_properties(mesh).volume;
        std::printf("%s: volume measured %.6g m3, expected %.6g, tolerance 1 %%\n", name.c_str(), measured, expected);
        // Chords of 2 degrees take 0.02 % of the wall; a grouser's sides are shorter at its tip and foot than h by
        // the chords' sagittas, w^2/8R over h: under 0.2 %.
        EXPECT_NEAR(measured, expected, 0.01 * expected);
        EXPECT_LT(mass_properties(mesh).centre.norm(), 1e-12);
    }
}

TEST(Wheel, PerseveranceIsThatOfThePaper)
{
    const scene::WheelGenerator g = builtin_wheel("perseverance");
    EXPECT_EQ(g.grousers, 48);
    EXPECT_EQ(g.radius, 0.26);
    // 0.0058 m3 in two digits of the paper.
    EXPECT_NEAR(mass_properties(wheel_mesh(g, "wheel")).volume, 0.0058, 0.01 * 0.0058);
}

/// Times that a circle about the axle enters the wheel.
int entries(const MeshDistance& wheel, double radius, double y)
{
    constexpr int steps  = 7200;
    int           count  = 0;
    const auto    inside = [&](int step)
    {
        const double angle = 2 * test::pi * (step + 0.5) / steps;
        return signed_distance(wheel, {radius * std::sin(angle), y, radius * std::cos(angle)}) < 0;
    };
    for (int step = 0; step < steps; ++step) { count += !inside(step) && inside(step + 1) ? 1 : 0; }
    return count;
}

TEST(Wheel, HasItsGrousersAndIsOpenInside)
{
    const scene::WheelGenerator g     = builtin_wheel("perseverance");
    const MeshDistance          wheel = prepare_distance(wheel_mesh(g, "wheel"));
    const double                drum  = g.radius - g.grouser_height;
    for (const double y : {-0.16, 0.0, 0.1})
    {
        EXPECT_EQ(entries(wheel, g.radius - 0.5 * g.grouser_height, y), 48);
        EXPECT_EQ(entries(wheel, 1.001 * g.radius, y), 0);
        EXPECT_EQ(entries(wheel, drum - g.wall_thickness - 1e-4, y), 0);
        EXPECT_LT(signed_distance(wheel, {0, y, drum - 0.5 * g.wall_thickness}), 0);
    }
    // On the axle the nearest wall is the inner one; its chords of 1.7 degrees lie 0.01 % inside.
    EXPECT_NEAR(signed_distance(wheel, {0, 0, 0}), drum - g.wall_thickness, 2e-4 * g.radius);
    EXPECT_GT(signed_distance(wheel, {0, 0, 0}), 0);
}

TEST(Wheel, ReachesItsRadiusAndWidth)
{
    const scene::WheelGenerator g       = builtin_wheel("viper");
    double                      largest = 0;
    const TriangleMesh          mesh    = wheel_mesh(g, "wheel");
    for (const auto& vertex : mesh.vertices) { largest = std::max(largest, std::hypot(vertex.x(), vertex.z())); }
    EXPECT_NEAR(largest, g.radius, 1e-15);
    EXPECT_DOUBLE_EQ(bounds(mesh).extent().y(), g.width);
}

TEST(Wheel, MayHaveNoGrousers)
{
    const TriangleMesh mesh = wheel_mesh({0.2, 0.1, 0.02, 0, 0.01, 0.01}, "drum");
    EXPECT_NO_THROW(require_watertight(mesh, "drum"));
    const double expected = test::pi * (0.2 * 0.2 - 0.18 * 0.18) * 0.1;
    // Chords of 2 degrees: the regular 180-gon has 1 - (2 pi/180)^2/6 = 0.9998 of the circle.
    EXPECT_NEAR(mass_properties(mesh).volume, expected * (1 - std::pow(test::pi / 90, 2) / 6), 1e-6 * expected);
}

TEST(Wheel, RejectsLengthsThatDoNotFit)
{
    scene::WheelGenerator thick;
    thick.wall_thickness = 0.25;
    EXPECT_THAT(test::input_error([&] { wheel_mesh(thick, "shape 'w'"); }),
                HasSubstr("shape 'w': wall_thickness = 0.25"));
    scene::WheelGenerator crowded;
    crowded.grouser_width = 0.04;
    EXPECT_THAT(test::input_error([&] { wheel_mesh(crowded, "w"); }), HasSubstr("grouser_width = 0.04"));
    scene::WheelGenerator flat;
    flat.width = 0;
    EXPECT_THAT(test::input_error([&] { wheel_mesh(flat, "w"); }), HasSubstr("width = 0"));
}

} // namespace
} // namespace tread::shape
