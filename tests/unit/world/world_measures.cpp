#include "world/world_measures.hpp"

#include <gtest/gtest.h>

#include "scene_text.hpp"

namespace tread::world
{
namespace
{

World built() { return build_world(test::load_text(test::sand_text + test::rocks_text)); }

TEST(WorldMeasures, AreTheSameForWhatIsBuiltTwiceAndForWhatWasRounded)
{
    const World one   = built();
    World       other = built();
    EXPECT_TRUE(are_same(measures(one), measures(other)));
    for (Vec3<double>& place : other.points.position) { place *= 1 + 1e-15; }
    EXPECT_TRUE(are_same(measures(one), measures(other)));
}

TEST(WorldMeasures, DistinguishAPointARockAndAShape)
{
    const std::vector<double> expected = measures(built());
    const auto                differs  = [&](const auto& change)
    {
        World world = built();
        change(world);
        return !are_same(expected, measures(world));
    };
    EXPECT_TRUE(differs([](World& world) { world.points.position.front()[2] += 1e-3; }));
    EXPECT_TRUE(differs([](World& world) { std::swap(world.points.position.front(), world.points.position.back()); }));
    EXPECT_TRUE(differs([](World& world) { world.points.mass.back() *= 1.01; }));
    EXPECT_TRUE(differs([](World& world) { world.bodies.position.back()[0] += 1e-3; }));
    EXPECT_TRUE(differs([](World& world) { world.bodies.scale.back() *= 1.001; }));
    EXPECT_TRUE(differs([](World& world) { world.templates.front().unit.volume *= 1.001; }));
}

} // namespace
} // namespace tread::world
