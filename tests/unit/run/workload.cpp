#include "run/workload.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "run/wall_time.hpp"
#include "scene_text.hpp"

// What `tread check` expects of phases, and the model of wall time.
namespace tread::run
{
namespace workload_test
{

/// The roller on its bed of 0.4 m, settled, lowered and driven.
const std::string phases_text = R"(
[[phase]]
name         = "settle"
until        = "equilibrium"
max_duration = 1.0
hold         = ["roller"]
[[phase]]
name         = "lower"
until        = "lowered"
max_duration = 3.0
lower        = { body = "roller", speed = 0.05 }
[[phase]]
name     = "drive"
duration = 40.0
drive    = { body = "roller", angular_velocity = 0.5, slip = 0.5 }
)";

std::string driven_text(const std::string& rest)
{
    std::string text = test::roller_text + rest;
    text.replace(text.find("[[phase]]"), text.find("[output]") - text.find("[[phase]]"), "");
    text.replace(text.find("lock     = [\"x\", \"y\","), 21, "lock     = [");
    text.replace(text.find("[0.4, 0.4, 0.6]"), 15, "[1.0, 0.4, 0.6]");
    return text.replace(text.find("[0.4, 0.4, 0.2]"), 15, "[1.0, 0.4, 0.2]");
}

struct Built
{
    explicit Built(const std::string& text, const std::vector<std::string>& overrides = {})
        : scene(test::load_text(text, overrides))
        , world(world::build_world(scene))
        , plan(solver::make_plan(scene, world))
        , wants(estimate(scene, world, plan))
        , rooms(drive_rooms(scene, world))
        , phases(expected_phases(scene, world, plan, wants, rooms))
        , work(workload(scene, world, plan, wants, phases))
    {
    }

    scene::Scene           scene;
    world::World           world;
    solver::Plan           plan;
    Estimate               wants;
    std::vector<DriveRoom> rooms;
    std::vector<PhasePace> phases;
    Workload               work;
};

TEST(Workload, PhasesThatEndByThemselvesEndSooner)
{
    const Built run(driven_text(phases_text));
    ASSERT_EQ(run.phases.size(), 3U);
    EXPECT_DOUBLE_EQ(run.phases[0].time, 0.05) << "the time for which equilibrium must hold";
    // The roller hangs 0.03 m above the bed, and sinks by some millimetres at 0.05 m/s.
    std::cout << "[ phases   ] lowered for " << run.phases[1].time << " s, driven for " << run.phases[2].time << " s\n";
    EXPECT_GT(run.phases[1].time, 0.03 / 0.05);
    EXPECT_LT(run.phases[1].time, 0.05 / 0.05);
    const std::vector<DriveWay> ways = drive_ways(run.scene, run.world, run.rooms);
    EXPECT_NEAR(run.phases[2].time, 40 * ways.at(0).to_end / ways.at(0).way, 1e-9) << "the drive ends with the bed";
    EXPECT_LT(run.phases[2].time, 40);
}

TEST(Workload, StepsAreShorterAndSearchesMoreFrequentUnderAMovingWheel)
{
    const Built run(driven_text(phases_text));
    EXPECT_DOUBLE_EQ(run.phases[0].dt, run.wants.dt);
    EXPECT_LT(run.phases[2].dt, run.wants.dt);
    EXPECT_GE(run.phases[0].searches, 1.0 / 8);
    EXPECT_LE(run.phases[0].searches, run.phases[1].searches);
    EXPECT_LE(run.phases[1].searches, run.phases[2].searches);
    EXPECT_LE(run.phases[2].searches, 1);
    const Built fixed(driven_text(phases_text), {"time.dt=1e-4"});
    EXPECT_DOUBLE_EQ(fixed.phases[2].dt, 1e-4);
}

TEST(Workload, IsLinearInWhatItCounts)
{
    const Built sand(test::sand_text), rocks(driven_text(test::rocks_text + phases_text));
    EXPECT_EQ(sand.work.bodies, 0);
    EXPECT_EQ(sand.work.substeps, 0);
    EXPECT_EQ(sand.work.near_substeps, 0);
    EXPECT_DOUBLE_EQ(sand.work.points, sand.work.sand_steps * static_cast<double>(sand.world.sand.size()));
    EXPECT_DOUBLE_EQ(rocks.work.searches, rocks.work.sand_steps) << "rocks are searched in every step";
    EXPECT_GE(rocks.work.substeps, rocks.work.sand_steps);
    EXPECT_GT(rocks.work.near_substeps, 0);
    EXPECT_DOUBLE_EQ(rocks.work.body_substeps, 9 * rocks.work.substeps) << "eight rocks and the roller";
}

TEST(Workload, BodiesThatMeetNeedSubsteps)
{
    const std::string second = R"(
[[body]]
name     = "second"
shape    = "roller"
material = "steel"
mass     = 4.0
lock     = ["x", "y", "roll", "pitch", "yaw"]
position = )";
    const auto        beside = [&](double x)
    { return fmt::format("{}[{}, 0.2, 0.33]\n[[phase]]\nname = \"drop\"\nduration = 0.1\n", second, x); };
    const Built apart(driven_text(beside(0.6))), near(driven_text(beside(0.401)));
    std::cout << "[ substeps ] " << apart.phases[0].substeps << " apart, " << near.phases[0].substeps
              << " side by side\n";
    EXPECT_EQ(apart.phases[0].substeps, 1);
    EXPECT_GT(near.phases[0].substeps, 1);
}

TEST(WallTime, SharesOutPointsAndBodiesAlone)
{
    const Workload work{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    const WorkCost cost{100, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    EXPECT_DOUBLE_EQ(wall_time(work, cost, 1), 100 + 15 + 51);
    EXPECT_DOUBLE_EQ(wall_time(work, cost, 5), 100 + 15 + 51.0 / 5);
}

} // namespace workload_test
} // namespace tread::run
