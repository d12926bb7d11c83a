#include <cmath>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "kernels/contact/samples_kern.hpp"
#include "scene_text.hpp"
#include "world/body_grid.hpp"
#include "world/materials.hpp"
#include "world/world.hpp"

namespace tread::world
{
namespace
{

std::string standing(std::string text, double gap)
{
    return text.replace(text.find("position = [0.2, 0.2, 0.33]"), 27,
                        "position = [0.2, 0.2, \"on surface\"]\ngap = " + std::to_string(gap));
}

double height_of(const std::string& text) { return build_world(test::load_text(text)).bodies.position[0][2]; }

/// Smallest distance of the roller's surface from the contact sphere of a sand point, m.
double clearance(const scene::Scene& scene, const World& world)
{
    double least = 1;
    for_each_point(world.sand,
                   [&](const SandPoint& point)
                   {
                       const auto rule = radius_rule(scene.numerics.point_radius);
                       least           = std::min(least, distance(world, 0, point.position) -
                                                             contact::point_radius(point.kind.volume, rule));
                   });
    return least;
}

TEST(OnSurface, StandsOnFlatSandByTheRadiusOfItsPoints)
{
    const scene::Scene scene = test::load_text(standing(test::roller_text, 0));
    const World        world = build_world(scene);
    EXPECT_GE(clearance(scene, world), 0);
    EXPECT_LE(clearance(scene, world), 1e-4);
    // Points are 25 mm apart, the highest 12.5 mm below the surface, the nearest 12.5 mm beside the roller's middle.
    const double radius = contact::point_radius(largest_volume(world.sand), radius_rule(scene.numerics.point_radius));
    const double along = 0.0125, roller = 0.1;
    EXPECT_NEAR(world.bodies.position[0][2], 0.2 - 0.0125 + std::sqrt(std::pow(roller + radius, 2) - along * along),
                1e-3);
}

TEST(OnSurface, LeavesTheGap)
{
    EXPECT_NEAR(height_of(standing(test::roller_text, 0.02)) - height_of(standing(test::roller_text, 0)), 0.02, 1e-12);
}

TEST(OnSurface, StandsAboveRocksThatAreYetToFallAndDoesNotMoveThem)
{
    const std::string rain = standing(test::roller_text, 0) + test::rocks_text + "placement = \"rain\"\n";
    std::string       text = rain;
    text.replace(text.find("[[0.0, 0.0, 0.02], [0.4, 0.4, 0.2]]"), 35, "[[0.0, 0.0, 0.23], [0.4, 0.4, 0.4]]");
    const World world = build_world(test::load_text(text));
    ASSERT_EQ(world.bodies.size(), 9u);
    double nearest = 1;
    for (std::size_t rock = 1; rock < world.bodies.size(); ++rock)
    {
        EXPECT_TRUE(apart(world, 0, rock, 0));
        nearest = std::min(nearest, apart(world, 0, rock, 1e-3) ? 1.0 : 0.0);
    }
    EXPECT_EQ(nearest, 0) << "it stands higher than it has to";

    std::string elsewhere = text;
    elsewhere.replace(elsewhere.find("[0.2, 0.2, \"on surface\"]\ngap = 0.000000"), 39, "[0.2, 0.2, 0.5]");
    const World other = build_world(test::load_text(elsewhere));
    for (std::size_t rock = 1; rock < world.bodies.size(); ++rock)
    {
        EXPECT_EQ(world.bodies.position[rock], other.bodies.position[rock]);
    }
}

TEST(OnSurface, NamesTheLineOfABodyThatDoesNotFitUnderTheTop)
{
    std::string text = standing(test::roller_text, 0.25);
    text.replace(text.find("[grid]"), 6, "walls = { top = \"slip\" }\n[grid]");
    try
    {
        build_world(test::load_text(text));
        FAIL() << "no error";
    }
    catch (const InputError& error)
    {
        const std::string what = error.what();
        EXPECT_NE(what.find("scene.toml:"), std::string::npos) << what;
        EXPECT_NE(what.find("(\"on surface\") puts it"), std::string::npos) << what;
    }
}

TEST(OnSurface, WantsSomethingToStandOn)
{
    std::string text = standing(test::roller_text, 0);
    text.replace(text.find("[0.4, 0.4, 0.2]"), 15, "[0.05, 0.4, 0.2]");
    EXPECT_THROW(build_world(test::load_text(text)), InputError);
}

} // namespace
} // namespace tread::world
