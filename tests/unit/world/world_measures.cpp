#include "world/world_measures.hpp"

#include <gtest/gtest.h>

#include "scene_text.hpp"

namespace tread::world
{
namespace
{

World built() { return build_world(test::load_text(test::sand_text + test::rocks_text)); }

std::vector<double> all_measures(const World& world) { return measures(world, body_measures(world.bodies)); }

TEST(WorldMeasures, AreTheSameForWhatIsBuiltTwiceAndForWhatWasRounded)
{
    const World one   = built();
    World       other = built();
    EXPECT_TRUE(are_same(all_measures(one), all_measures(other)));
    for (PointRow& row : other.sand.rows) { row.z *= 1 + 1e-15; }
    EXPECT_TRUE(are_same(all_measures(one), all_measures(other)));
}

TEST(WorldMeasures, DistinguishAPointARockAndAShape)
{
    const World               unchanged = built();
    const std::vector<double> expected  = all_measures(unchanged);
    const auto                differs   = [&](const auto& change)
    {
        World world = unchanged;
        change(world);
        return !are_same(expected, all_measures(world));
    };
    EXPECT_TRUE(differs(
        [](World& world)
        {
            const Vec3<double> aside = Vec3<double>::UnitZ() * 1e-3;
            apply_changes({{0, point_of(world.sand, 0).position + aside}}, world.sand);
        }));
    EXPECT_TRUE(differs(
        [](World& world)
        {
            const std::size_t last = world.sand.size() - 1;
            apply_changes({{0, point_of(world.sand, last).position}, {last, point_of(world.sand, 0).position}},
                          world.sand);
        }));
    EXPECT_TRUE(differs([](World& world) { world.sand.kinds.back().mass *= 1.01; }));
    EXPECT_TRUE(differs([](World& world) { world.bodies.position.back()[0] += 1e-3; }));
    EXPECT_TRUE(differs([](World& world) { world.bodies.scale.back() *= 1.001; }));
    EXPECT_TRUE(differs([](World& world) { world.templates.front().unit.volume *= 1.001; }));
}

} // namespace
} // namespace tread::world
