#include <cmath>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "scene_text.hpp"
#include "world/host_points.hpp"
#include "world/region.hpp"
#include "world/terrain.hpp"

namespace
{

using namespace tread;
using namespace tread::world;
using test::load_text;

constexpr double pi = std::numbers::pi;

std::string scene_of(const std::string& size, const std::string& spacing, const std::string& terrain)
{
    return "[domain]\nsize = " + size + "\ngravity = [0, 0, -9.81]\n[grid]\nspacing = " + spacing + R"(
[[material]]
name    = "sand"
model   = "elastic"
density = 1000.0
young   = 1.0e6
[[material]]
name    = "clay"
model   = "elastic"
density = 2000.0
young   = 1.0e6
[[phase]]
name     = "rest"
duration = 0.01
)" + terrain;
}

HostPoints points_of(const std::string& size, const std::string& spacing, const std::string& terrain)
{
    const auto scene = load_text(scene_of(size, spacing, terrain));
    World      world{};
    world.sand = make_terrain(scene);
    return make_points(scene, world, world.sand.rows);
}

double total(const std::vector<double>& values)
{
    double sum = 0;
    for (const double value : values) { sum += value; }
    return sum;
}

/// Number of points of the paper's head-on spheres (docs/verification.md#head-on-collision): R = 0.2 m, h = 0.01 m,
/// centre on a node of the grid.
TEST(Terrain, SpheresHaveThePapersPoints)
{
    const std::string sphere =
        "[[terrain]]\nmaterial = \"sand\"\nregion = { sphere = { centre = [0.25, 0.25, 0.25], radius = 0.2 } }\n";
    const auto one    = points_of("[0.5, 0.5, 0.5]", "0.01", sphere + "points_per_cell = 1\n");
    const auto twenty = points_of("[0.5, 0.5, 0.5]", "0.01", sphere + "points_per_cell = 27\n");
    std::cout << "points of the sphere: " << one.size() << " and " << twenty.size() << "; expected 33552 and 904960\n";
    EXPECT_EQ(one.size(), 33552u);
    EXPECT_EQ(twenty.size(), 904960u);
}

/// Over one wavelength 0.1 sin(2 pi x) + 0.1 has the mean 0.1: volume 0.1 m2 times the width. Points at the centres of
/// cells: a column holds round(f/h) of them, off by at most h/2, and the errors of 100 x 2 columns at h/2 = 5 mm point
/// spacing add as a random walk (and cancel, since f - 0.1 is odd): 1 % of the volume is ample.
TEST(Terrain, ARippleHasItsVolume)
{
    const auto points =
        points_of("[1.0, 0.2, 0.3]", "0.01", "[[terrain]]\nmaterial = \"sand\"\nheight = \"0.1*sin(2*pi*x) + 0.1\"\n");
    const double measured = total(points.volume), expected = 0.1 * 0.2;
    std::cout << "ripple: " << measured << " m3, expected " << expected << ", tolerance 1 %\n";
    EXPECT_NEAR(measured, expected, 0.01 * expected);
    for (const auto& x : points.position) { ASSERT_LT(x[2], 0.1 * std::sin(2 * pi * x[0]) + 0.1); }
}

/// The same integral by columns, by which the solid fraction of rocks is divided: midpoints of a sine over its period
/// are exact to rounding.
TEST(Terrain, VolumeOfASpaceIsItsIntegral)
{
    const auto scene = load_text(scene_of(
        "[1.0, 0.2, 0.3]", "0.01",
        "[[terrain]]\nmaterial = \"sand\"\nheight = \"0.1*sin(2*pi*x) + 0.1\"\n"
        "[[terrain]]\nmaterial = \"sand\"\nregion = { box = [[0, 0, 0], [0.5, 0.2, 0.3]], except = [[[0.1, 0.05, 0.1], "
        "[0.3, 1, 0.2]], [[0.2, 0, 0.15], [0.4, 0.1, 1]]] }\n"
        "[[terrain]]\nmaterial = \"sand\"\nregion = { sphere = { centre = [0.5, 0.1, 0.1], radius = 0.09 } }\n"));
    const auto space = [&](std::size_t i)
    { return make_space(scene.terrain[i].region, scene.terrain[i].height, scene.terrain[i].floor, "test"); };
    EXPECT_NEAR(volume(space(0)), 0.02, 1e-12);
    // Inclusion and exclusion; the two boxes share [0.2, 0.3] x [0.05, 0.1] x [0.15, 0.2].
    const double boxes = 0.5 * 0.2 * 0.3 - 0.2 * 0.15 * 0.1 - 0.2 * 0.1 * 0.15 + 0.1 * 0.05 * 0.05;
    EXPECT_NEAR(volume(space(1)), boxes, 1e-12);
    // Chords end as square roots: 512 columns leave an error of 1e-4 at most.
    const double ball = 4.0 / 3 * pi * std::pow(0.09, 3);
    std::cout << "ball: " << volume(space(2)) << " m3, expected " << ball << ", tolerance 1e-4 of it\n";
    EXPECT_NEAR(volume(space(2)), ball, 1e-4 * ball);
}

/// Two layers of equal thickness under a sloping surface: each column holds as many points of one as of the other, and
/// they meet at the floor of the upper one.
TEST(Terrain, LayersFollowTheSurface)
{
    const auto points =
        points_of("[0.4, 0.2, 0.4]", "0.02",
                  "[[terrain]]\nmaterial = \"clay\"\nheight = \"0.1 + 0.3*x\"\nfloor = \"0.3*x\"\n"
                  "[[terrain]]\nmaterial = \"sand\"\nheight = \"0.2 + 0.3*x\"\nfloor = \"0.1 + 0.3*x\"\n");
    std::size_t upper = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const auto&  x    = points.position[i];
        const double base = 0.3 * x[0];
        const bool   sand = points.material[i] == 0;
        upper += sand ? 1 : 0;
        ASSERT_EQ(sand, x[2] >= base + 0.1);
        ASSERT_GE(x[2], base);
        ASSERT_LT(x[2], base + 0.2);
    }
    // 0.1 m is ten points of a column on any slope.
    EXPECT_EQ(upper, 40u * 20 * 10);
    EXPECT_EQ(points.size(), 2 * upper);
}

/// A core of sand in a ripple of clay: the core replaces the ripple in its box, and no place is filled twice.
TEST(Terrain, ALaterTableReplacesAnEarlierOne)
{
    const std::string ripple = "[[terrain]]\nmaterial = \"clay\"\nheight = \"0.1*sin(2*pi*x) + 0.1\"\n";
    const std::string core   = "[[terrain]]\nmaterial = \"sand\"\nregion = { box = [[0.1, 0, 0], [0.4, 0.2, 0.16]] }\n"
                               "height = \"0.1*sin(2*pi*x) + 0.1\"\n";
    const auto        whole  = points_of("[1.0, 0.2, 0.3]", "0.01", ripple);
    const auto        both   = points_of("[1.0, 0.2, 0.3]", "0.01", ripple + core);
    ASSERT_EQ(both.size(), whole.size());
    std::size_t sand = 0;
    for (std::size_t i = 0; i < both.size(); ++i)
    {
        const auto& x          = both.position[i];
        const bool  core_point = x[0] >= 0.1 && x[0] < 0.4 && x[2] < 0.16;
        ASSERT_EQ(both.material[i] == 0, core_point);
        ASSERT_EQ(both.terrain[i], core_point ? 1 : 0);
        sand += core_point ? 1 : 0;
    }
    std::cout << "ripple of " << both.size() << " points, " << sand << " of them in its core\n";
    EXPECT_GT(sand, 0u);
}

TEST(Terrain, ALatticeOfItsOwnBeginsAtTheLowCorner)
{
    const auto points = points_of("[0.5, 0.5, 0.5]", "0.05",
                                  "[[terrain]]\nmaterial = \"sand\"\nspacing = 0.015\nvelocity = [0, 0, -1]\n"
                                  "region = { box = [[0.01, 0.02, 0.03], [0.31, 0.32, 0.18]] }\n");
    ASSERT_EQ(points.size(), 20u * 20 * 10);
    EXPECT_LT((points.position[0] - Vec3<double>(0.0175, 0.0275, 0.0375)).norm(), 1e-15);
    EXPECT_DOUBLE_EQ(points.volume[0], 0.015 * 0.015 * 0.015);
    EXPECT_EQ(points.velocity.at(0), Vec3<double>(0, 0, -1));
}

TEST(Terrain, AtRestCarriesNoVelocities)
{
    EXPECT_TRUE(points_of("[0.4, 0.4, 0.4]", "0.05", "[[terrain]]\nmaterial = \"sand\"\n").velocity.empty());
}

std::string refusal(const std::string& terrain)
{
    try
    {
        points_of("[1.0, 0.2, 0.3]", "0.05", "[[terrain]]\nmaterial = \"sand\"\n" + terrain);
    }
    catch (const InputError& error)
    {
        return error.what();
    }
    return {};
}

TEST(Terrain, HeightsThatAreNoneAreRefusedWithThePlace)
{
    const auto message = refusal("height = \"sqrt(0.5 - x)\"\n");
    EXPECT_NE(message.find("[[terrain]] 0 height = \"sqrt(0.5 - x)\" is"), std::string::npos) << message;
    EXPECT_NE(message.find("at x = 0.5125, y = 0.0125 (m)"), std::string::npos) << message;
}

TEST(Terrain, ATableWithoutPointsIsRefused)
{
    const auto message = refusal("height = \"-1\"\n");
    EXPECT_NE(message.find("[[terrain]] 0: no point of its lattice"), std::string::npos) << message;
}

} // namespace
