#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "scene/resolved.hpp"
#include "scene/slope.hpp"
#include "scene_file.hpp"

namespace tread::scene::test
{
namespace
{

using ::testing::HasSubstr;

Scene with_gravity(const Directory& directory, const std::string& lines)
{
    return load_scene(directory.write("scene.toml", replaced(good_scene, "gravity = [0, 0, -9.81]", lines)), {});
}

TEST(Slope, IsExactWhereTheGroundIsLevelOrAWall)
{
    EXPECT_EQ(gravity_on({9.81, 0, 0}), (Vector3{0, 0, -9.81}));
    EXPECT_EQ(gravity_on({9.81, 90, 0}), (Vector3{-9.81, 0, 0}));
    EXPECT_EQ(gravity_on({9.81, 90, 180}), (Vector3{9.81, 0, 0}));
    EXPECT_EQ(gravity_on({9.81, -90, 90}), (Vector3{0, 9.81, 0}));
    EXPECT_EQ(gravity_on({9.81, 90, -270}), (Vector3{0, -9.81, 0}));
    for (const double component : gravity_on({1, 0, 0})) { EXPECT_FALSE(component == 0 && std::signbit(component)); }
}

TEST(Slope, LeansAgainstTheWayThatItClimbs)
{
    const double  angle = 20 * std::acos(-1.0) / 180, way = 30 * std::acos(-1.0) / 180;
    const Vector3 g = gravity_on({1.62, 20, 30});
    // Rounding of a product of three.
    EXPECT_NEAR(g[0], -1.62 * std::sin(angle) * std::cos(way), 1e-15);
    EXPECT_NEAR(g[1], -1.62 * std::sin(angle) * std::sin(way), 1e-15);
    EXPECT_NEAR(g[2], -1.62 * std::cos(angle), 1e-15);
    const Vector3 down = gravity_on({1.62, -20, 30});
    EXPECT_EQ(down, (Vector3{-g[0], -g[1], g[2]}));
    const Vector3 turned = gravity_on({1.62, 20, 210});
    for (std::size_t c = 0; c < 3; ++c) { EXPECT_NEAR(turned[c], down[c], 1e-15); }
}

TEST(Slope, ResolvesToTheVectorOfItsTwin)
{
    const Directory directory;
    const Scene     level = with_gravity(directory, "gravity = [0, 0, -9.81]");
    EXPECT_EQ(with_gravity(directory, "gravity_size = 9.81"), level);

    const Scene   slope = with_gravity(directory, "gravity_size = 9.81\nslope_deg = 15\nslope_direction_deg = -40");
    const auto    text  = resolved_toml(slope);
    const Vector3 g     = gravity_on({9.81, 15, -40});
    EXPECT_EQ(slope.domain.gravity, g);
    EXPECT_THAT(text, HasSubstr(fmt::format("\ngravity = [{}, {}, {}]\n", g[0], g[1], g[2])));
    EXPECT_THAT(text, ::testing::Not(HasSubstr("slope")));
    const Scene again = load_scene(directory.write("again.toml", text), {});
    EXPECT_EQ(again, slope);
    EXPECT_EQ(scene_hash(again), scene_hash(slope));
}

TEST(Slope, OfNoGravityIsWeightless)
{
    const std::string text = replaced(good_scene, "gravity = [0, 0, -9.81]", "gravity_size = 0");
    EXPECT_THAT(refusal(replaced(text, "mass = 10", "load = 10")), HasSubstr("a load needs gravity"));
    EXPECT_THAT(refusal(replaced(replaced(good_scene, "gravity = [0, 0, -9.81]", "gravity_size = \"Mars\""),
                                 "mass = 10", "load = 10")),
                ::testing::Not(HasSubstr("a load needs gravity")));
}

} // namespace
} // namespace tread::scene::test
