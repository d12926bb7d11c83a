#include <cmath>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "kernels/contact/samples_kern.hpp"
#include "scene_text.hpp"
#include "world/body_grid.hpp"
#include "world/host_points.hpp"
#include "world/terrain.hpp"

namespace
{

using namespace tread;
using namespace tread::world;
using test::load_text;

TEST(World, ReplacedRocksOverlapNeitherSandNorEachOther)
{
    const World  world  = build_world(load_text(test::sand_text + test::rocks_text));
    const auto&  bodies = world.bodies;
    const auto&  form   = world.templates.at(0);
    const double reach  = contact::point_radius(largest_volume(world.sand), contact::RadiusRule::sphere);
    ASSERT_EQ(bodies.size(), 8u);
    double nearest_point = 1, nearest_node = 1;
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const Mat3<double> rotation = bodies.orientation[b].toRotationMatrix();
        const auto         distance = [&](const Vec3<double>& x)
        {
            return bodies.scale[b] *
                   shape::sample(form.sdf, rotation.transpose() * (x - bodies.position[b]) / bodies.scale[b]);
        };
        for_each_point(world.sand, [&](const SandPoint& point)
                       { nearest_point = std::min(nearest_point, distance(point.position)); });
        for (std::size_t other = 0; other < bodies.size(); ++other)
        {
            if (other == b) { continue; }
            for (const auto& node : form.nodes.positions)
            {
                nearest_node = std::min(nearest_node, distance(bodies.position[other] +
                                                               bodies.orientation[other] * node * bodies.scale[other]));
            }
        }
    }
    std::cout << "nearest point of sand to a rock: " << nearest_point << " m, contact begins at " << reach
              << " m; nearest rock node to another rock: " << nearest_node << " m, contact begins at 0\n";
    EXPECT_GE(nearest_point, reach * (1 - 1e-12));
    EXPECT_GT(nearest_node, 0);
    EXPECT_LT(world.sand.size(), 4u * 8 * 8 * 8); // some sand was removed
}

TEST(World, SampledRocksKeepClearOfTheSamples)
{
    const auto nearest = [](const std::string& numerics)
    {
        const World  world  = build_world(load_text(test::sand_text + test::rocks_text + numerics));
        const double radius = contact::point_radius(largest_volume(world.sand), contact::RadiusRule::sphere);
        double       least  = 1;
        for (std::size_t b = 0; b < world.bodies.size(); ++b)
        {
            const auto sample = [&](const SandPoint& point)
            {
                const Vec3<double>& x    = point.position;
                const auto          axes = contact::patch_axes((x - world.bodies.position[b]).normalized());
                for (int s = 0; s < contact::patch_samples; ++s)
                {
                    least = std::min(least, distance(world, b, x + contact::patch_offset(axes, s, radius)) / radius);
                }
            };
            for_each_point(world.sand, sample);
        }
        return least;
    };
    const double sampled = nearest("[numerics]\nrefine_below = 3.0\n"), plain = nearest("");
    std::cout << "[ measured ] nearest sample over the point radius " << sampled
              << " (at least 1); where rocks are not "
              << "sampled " << plain << "\n";
    EXPECT_GE(sampled, 1);
    EXPECT_LT(plain, 1);
}

TEST(World, TheSameSeedGivesTheSameRocksAndAnotherDoesNot)
{
    const auto first  = build_world(load_text(test::sand_text + test::rocks_text)).bodies;
    const auto second = build_world(load_text(test::sand_text + test::rocks_text)).bodies;
    const auto other  = build_world(load_text(test::sand_text + test::rocks_text + "seed = 2\n")).bodies;
    EXPECT_EQ(first.position, second.position);
    EXPECT_NE(first.position, other.position);
}

TEST(World, RocksThatAreReleasedStillCount)
{
    World             world = build_world(load_text(test::sand_text + test::rocks_text));
    const std::size_t count = world.bodies.size();
    ASSERT_GT(count, static_cast<std::size_t>(world.bodies.named));
    EXPECT_NO_THROW(world.bodies.require_rocks());
    release_rocks(world);
    release_rocks(world);
    EXPECT_THROW(world.bodies.require_rocks(), std::logic_error);
    EXPECT_EQ(world.bodies.size(), count);
    EXPECT_EQ(world.bodies.position.capacity(), static_cast<std::size_t>(world.bodies.named));
    EXPECT_EQ(world.bodies.material.capacity(), static_cast<std::size_t>(world.bodies.named));
}

TEST(World, TooManyRocksAreRefusedWithTheNumberThatFits)
{
    try
    {
        build_world(load_text(test::sand_text + test::rocks_text, {"rocks[0].count=4000"}));
        FAIL() << "4000 rocks of 6 cm cannot fit";
    }
    catch (const InputError& error)
    {
        EXPECT_NE(std::string(error.what()).find("count = 4000"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("clast"), std::string::npos) << error.what();
    }
}

TEST(World, RocksInSandWithoutReplaceAreRefused)
{
    EXPECT_THROW(build_world(load_text(test::sand_text + test::rocks_text + "placement = \"rain\"\n")), InputError);
}

std::string two_balls(double second)
{
    std::string text = test::roller_text;
    text.replace(text.find("kind = \"wheel\""), text.find(" }\nsdf_cells") - text.find("kind = \"wheel\""),
                 "kind = \"sphere\", nodes = 162");
    text.replace(text.find("mass     = 4.0"), 14, "mass     = 4.0\ndiameter = 0.1");
    text.erase(text.find("node_spacing"), text.find("[[body]]") - text.find("node_spacing")); // a wheel's
    return text + fmt::format(R"(
[[body]]
name     = "second"
shape    = "roller"
material = "steel"
mass     = 4.0
diameter = 0.1
position = [0.2, 0.2, {}]
)",
                              second);
}

/// Balls with one centre and one radius have no node inside each other, yet must be refused.
TEST(World, BodiesInEachOtherAreRefused)
{
    EXPECT_THROW(build_world(load_text(two_balls(0.33))), InputError);
    EXPECT_THROW(build_world(load_text(two_balls(0.35))), InputError);
    EXPECT_NO_THROW(build_world(load_text(two_balls(0.428)))) << "a contact that holds them, from the start";
}

TEST(World, TheBedHasTheMassOfItsBox)
{
    const World world = build_world(load_text(test::sand_text));
    EXPECT_NEAR(total_mass(world.sand), 1600 * 0.4 * 0.4 * 0.2, 1e-9);
}

/// docs/verification.md#geostatic-column: sigma_h = max(K0, Ka) sigma_v; here K0 = 0.4286 > Ka = 1/3. Exact on a
/// lattice: the stress of a point is the weight above its centre.
TEST(World, TheBedStartsGeostatic)
{
    const auto       scene  = load_text(test::sand_text);
    const World      world  = build_world(scene);
    const HostPoints points = make_points(scene, world, world.sand.rows);
    double           worst  = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const double vertical = 1600 * 9.81 * (0.2 - points.position[i][2]);
        worst                 = std::max(
                            {worst, std::abs(-points.stress[i][2] - vertical), std::abs(-points.stress[i][0] - 0.3 / 0.7 * vertical)});
    }
    std::cout << "geostatic start: worst error " << worst << " Pa of " << 1600 * 9.81 * 0.2 << ", tolerance 1e-8 Pa\n";
    EXPECT_LT(worst, 1e-8);
}

} // namespace
