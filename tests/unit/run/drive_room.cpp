#include "run/drive_room.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "scene_text.hpp"

namespace tread::run
{
namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The roller (radius 0.1 m) at x = 0.15 m on sand from 0 to 0.8 m.
std::string bed_text(const std::string& walls, const std::string& phases)
{
    std::string text = test::roller_text + phases;
    text.replace(text.find("[0.4, 0.4, 0.6]"), 15, "[1.0, 0.4, 0.6]");
    text.replace(text.find("[0.4, 0.4, 0.2]"), 15, "[1.0, 0.4, 0.2]");
    text.replace(text.find("position = [0.2,"), 16, "position = [0.3,");
    return text.replace(text.find("[grid]"), 6, "walls = { x = \"" + walls + "\" }\n[grid]");
}

std::string drive(double speed, double duration, const std::string& name = "drive")
{
    return "\n[[phase]]\nname = \"" + name + "\"\nduration = " + std::to_string(duration) +
           "\ndrive = { body = \"roller\", angular_velocity = " + std::to_string(speed) + ", slip = 0.0 }\n";
}

struct Built
{
    explicit Built(const std::string& text)
        : scene(test::load_text(text))
        , world(world::build_world(scene))
        , rooms(drive_rooms(scene, world))
    {
    }

    std::vector<std::string> warnings() const { return drive_warnings(scene, world, rooms); }

    scene::Scene           scene;
    world::World           world;
    std::vector<DriveRoom> rooms;
};

/// Clearance kept at the end of the drive: the radius and 5 % of it, and two cells of 0.05 m.
constexpr double kept = 1.05 * 0.1 + 2 * 0.05;

TEST(DriveRoom, EndsBeforeTheWalls)
{
    const Built built(bed_text("slip", drive(1.0, 1.0)));
    ASSERT_EQ(built.rooms.size(), 1u);
    EXPECT_NEAR(built.rooms[0].reach, 0.1, 1e-3);
    EXPECT_NEAR(built.rooms[0].front.axle, 1.0 - kept, 1e-3);
    EXPECT_NEAR(built.rooms[0].back.axle, kept, 1e-3);
    EXPECT_EQ(built.rooms[0].front.what, "the wall at x = 1 m");
    EXPECT_TRUE(built.warnings().empty());
}

/// Sums by hand: of a drum of radius r and half width w, a yaw of 60 degrees shows r cos 60 + w sin 60 along x, and a
/// camber of 30 degrees r cos 30 + w sin 30 downwards.
TEST(DriveRoom, LooksAtABodyAsItIsTurned)
{
    const auto turned = [](const std::string& angle)
    {
        std::string text = bed_text("slip", drive(1.0, 1.0));
        return text.replace(text.find("lock     ="), 0, angle + "\n");
    };
    const double r = 0.1, w = 0.075;
    const Built  yawed(turned("yaw_deg = 60.0")), leaning(turned("camber_deg = 30.0"));
    EXPECT_NEAR(yawed.rooms[0].reach, r * 0.5 + w * std::sqrt(0.75), 1e-3);
    EXPECT_NEAR(yawed.rooms[0].depth, r, 1e-3);
    EXPECT_NEAR(leaning.rooms[0].reach, r, 1e-3);
    EXPECT_NEAR(leaning.rooms[0].depth, r * std::sqrt(0.75) + w * 0.5, 1e-3);
}

TEST(DriveRoom, EndsBeforeTheEdgeOfTheTerrain)
{
    std::string text = bed_text("slip", drive(1.0, 1.0));
    text.replace(text.find("[1.0, 0.4, 0.2]"), 15, "[0.8, 0.4, 0.2]");
    const Built built(text);
    EXPECT_NEAR(built.rooms[0].front.axle, 0.8 - kept, 0.01); // the strip is sampled in sixteenths of the radius
    EXPECT_NE(built.rooms[0].front.what.find("the edge of the terrain"), std::string::npos);
    const Built open(bed_text("open", drive(1.0, 1.0)));
    EXPECT_NEAR(open.rooms[0].front.axle, 1.0 - kept, 0.01);
    EXPECT_NE(open.rooms[0].front.what.find("the edge of the terrain"), std::string::npos);
}

TEST(DriveRoom, AddsUpTheDrivesAndGivesTheDurationThatFits)
{
    // 0.495 m at 0.1 m/s: 4.95 s, 3 of them in the first drive.
    const Built built(bed_text("slip", drive(1.0, 3.0) + drive(1.0, 3.0, "on")));
    const auto  warnings = built.warnings();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].find("phase 'on': 'roller' has 0.19"), 0u) << warnings[0];
    EXPECT_NE(warnings[0].find("a duration of 1.9"), std::string::npos) << warnings[0];
}

TEST(DriveRoom, GoesBackwardsByTheSignOfTheSpin)
{
    const Built built(bed_text("slip", drive(-1.0, 2.0)));
    ASSERT_EQ(built.warnings().size(), 1u); // 0.095 m of room
    EXPECT_NE(built.warnings()[0].find("the wall at x = 0 m"), std::string::npos);
    const scene::Drive& back = *built.scene.phases[1].drive;
    EXPECT_EQ(reached_end(built.rooms[0], back, kept + 0.01), nullptr);
    EXPECT_NE(reached_end(built.rooms[0], back, kept - 0.01), nullptr);
    EXPECT_EQ(reached_end(built.rooms[0], back, 0.95), nullptr) << "it drives away from that wall";
}

TEST(DriveRoom, WarnsOfABodyInTheWay)
{
    const Built built(bed_text("slip", drive(1.0, 3.0)) + R"(
[[body]]
name     = "post"
shape    = "roller"
material = "steel"
mass     = 4.0
position = [0.62, 0.2, 0.33]
)");
    ASSERT_EQ(built.warnings().size(), 1u);
    EXPECT_NE(built.warnings()[0].find("'roller' may meet 'post'"), std::string::npos) << built.warnings()[0];
}

TEST(DriveRoom, KnowsABodyThatHasLeft)
{
    const Built      built(bed_text("open", drive(1.0, 1.0)));
    const DriveRoom& room = built.rooms[0];
    EXPECT_FALSE(has_left(room, {0.3, 0.2, 0.25}));
    EXPECT_TRUE(has_left(room, {1.02, 0.2, 0.25})) << "over the edge ahead";
    EXPECT_TRUE(has_left(room, {0.3, 0.43, 0.25})) << "over the edge beside";
    EXPECT_TRUE(has_left(room, {0.3, 0.2, 0.08})) << "under the floor";
}

TEST(DriveRoom, ComputesTheDistanceToTheEndAhead)
{
    const Built         built(bed_text("slip", drive(1.0, 1.0) + drive(-1.0, 1.0, "back")));
    const DriveRoom&    room = built.rooms[0];
    const scene::Drive &on = *built.scene.phases[1].drive, &back = *built.scene.phases[2].drive;
    for (const double x : {0.3, 0.6, 0.9})
    {
        EXPECT_DOUBLE_EQ(distance_to_end(room, on, x), room.front.axle - x);
        EXPECT_DOUBLE_EQ(distance_to_end(room, back, x), x - room.back.axle);
    }
    scene::Drive still     = on;
    still.angular_velocity = 0;
    EXPECT_EQ(distance_to_end(room, still, 0.3), infinity) << "it goes nowhere";
    DriveRoom endless  = room;
    endless.front.axle = infinity;
    EXPECT_EQ(distance_to_end(endless, on, 0.3), infinity);
    EXPECT_EQ(reached_end(endless, on, 1e9), nullptr);
}

TEST(DriveRoom, ComputesTheLeastDistanceToTheEdges)
{
    const Built              built(bed_text("open", drive(1.0, 1.0)));
    const DriveRoom&         room   = built.rooms[0];
    const DriveRoom::Ground& ground = *room.ground;
    EXPECT_DOUBLE_EQ(distance_to_leave(room, {ground.low_x + 0.01, 0.2, 0.3}), 0.01) << "behind";
    EXPECT_NEAR(distance_to_leave(room, {ground.high_x - 0.01, 0.2, 0.3}), 0.01, 1e-12) << "ahead";
    EXPECT_NEAR(distance_to_leave(room, {0.5, ground.low_y + 0.01, 0.3}), 0.01, 1e-12) << "beside";
    EXPECT_NEAR(distance_to_leave(room, {0.5, ground.high_y - 0.01, 0.3}), 0.01, 1e-12) << "beside";
    const double lowest = ground.floor + 0.9 * room.depth;
    EXPECT_NEAR(distance_to_leave(room, {0.5, 0.2, lowest + 0.01}), 0.01, 1e-12) << "down";
    EXPECT_NEAR(distance_to_leave(room, {ground.high_x + 0.02, 0.2, 0.3}), -0.02, 1e-12) << "it has left";
    DriveRoom bare = room;
    bare.ground.reset();
    EXPECT_EQ(distance_to_leave(bare, {5, 5, -5}), infinity);
    EXPECT_FALSE(has_left(bare, {5, 5, -5}));
}

} // namespace
} // namespace tread::run
