#include "world/orientation.hpp"

#include <cmath>
#include <iostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "scene_text.hpp"
#include "world/body_grid.hpp"
#include "world/world.hpp"

namespace tread::world
{
namespace
{

using ::testing::HasSubstr;

scene::Orientation wheel(double yaw, double camber) { return {{}, {}, {}, yaw, camber}; }

double apart(const Vec3<double>& one, const Vec3<double>& other) { return (one - other).norm(); }

TEST(Orientation, YawTurnsTheHeadingToTheLeftAndCamberLeansTheTopToTheRight)
{
    const Vec3<double> x = Vec3<double>::UnitX(), y = Vec3<double>::UnitY(), z = Vec3<double>::UnitZ();
    EXPECT_LT(apart(rotation_of(wheel(90, 0)) * x, y), 1e-15);
    EXPECT_LT(apart(rotation_of(wheel(90, 0)) * y, -x), 1e-15);
    EXPECT_LT(apart(rotation_of(wheel(0, 90)) * z, -y), 1e-15);
    // Camber is about the heading: heading along y, whose right is +x.
    EXPECT_LT(apart(rotation_of(wheel(90, 90)) * z, x), 1e-15);
    EXPECT_LT(apart(rotation_of(wheel(90, 90)) * x, y), 1e-15);
    const Vec3<double> heading = rotation_of(wheel(20, 10)) * x;
    EXPECT_NEAR(heading[2], 0, 1e-15);
    EXPECT_NEAR(std::atan2(heading[1], heading[0]) * 180 / std::acos(-1.0), 20, 1e-12);
    EXPECT_EQ(rotation_of({}).coeffs(), Quat::Identity().coeffs());
}

TEST(Orientation, AnAxisOfAnyLengthAndRowsSayTheSame)
{
    const Quat axis = rotation_of({scene::Vector3{0, 0, 7}, std::atan2(0.8, 0.6) * 180 / std::acos(-1.0), {}, {}, {}});
    const Quat rows = rotation_of({{}, {}, scene::Matrix3{{{0.6, -0.8, 0}, {0.8, 0.6, 0}, {0, 0, 1}}}, {}, {}});
    EXPECT_LT(axis.angularDistance(rows), 1e-7); // the square root of rounding
    EXPECT_LT(apart(rows * Vec3<double>::UnitX(), Vec3<double>(0.6, 0.8, 0)), 1e-15);
    EXPECT_NEAR(rows.norm(), 1, 1e-15);
}

/// The sand of roller_text and a box above it; `lines` of its [[body]].
std::string box_text(const std::string& size, const std::string& lines)
{
    return test::sand_text + R"(
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e9
poisson = 0.3
[[shape]]
name     = "box"
generate = { kind = "box", size = )" +
           size + R"( }
[[body]]
name     = "box"
shape    = "box"
material = "steel"
mass     = 1.0
)" + lines;
}

TEST(Orientation, ABodyOnTheSurfaceStandsOnItsLowestEdge)
{
    const World world = build_world(test::load_text(
        box_text("[0.06, 0.1, 0.06]", "axis = [0, 1, 0]\nangle_deg = 45\nposition = [0.2, 0.2, \"on surface\"]\n")));
    // The edge along y goes down between two rows of points, 12.5 mm to each side and 12.5 mm below the surface, until
    // its faces, inclined by 45 degrees, are a point's radius from them.
    const double radius   = std::cbrt(3 / (4 * std::acos(-1.0))) * 0.025;
    const double edge     = 0.2 - 0.0125 - 0.0125 + std::sqrt(2) * radius;
    const double expected = edge + 0.06 / std::sqrt(2);
    std::cout << "height measured " << world.bodies.position[0][2] << " m, expected " << expected
              << ", tolerance 9e-4: half a cell of the field, which rounds the edge\n";
    EXPECT_NEAR(world.bodies.position[0][2], expected, 9e-4);
    EXPECT_GT(world.bodies.position[0][2], 0.2 + 0.03) << "it stands as if it were level";
}

TEST(Orientation, WallsAreMetByTheTurnedBody)
{
    const auto refused = [](const std::string& lines)
    {
        try
        {
            build_world(test::load_text(box_text("[0.3, 0.02, 0.02]", lines)));
        }
        catch (const InputError& error)
        {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string middle = "position = [0.2, 0.2, 0.4]\n", beside = "position = [0.2, 0.1, 0.4]\n";
    EXPECT_EQ(refused(beside), "");
    EXPECT_EQ(refused("yaw_deg = 90\n" + middle), "");
    // Half its length of 0.15 m and half its width, turned by 60 degrees.
    const std::string what = refused("yaw_deg = 60\n" + beside);
    EXPECT_THAT(what, HasSubstr("scene.toml:"));
    EXPECT_THAT(what, HasSubstr("puts it 0.0349 m into a wall"));
    EXPECT_EQ(refused("yaw_deg = 90\nposition = [0.02, 0.2, 0.4]\n"), "");
    EXPECT_THAT(refused("position = [0.02, 0.2, 0.4]\n"), HasSubstr("into a wall"));
}

} // namespace
} // namespace tread::world
