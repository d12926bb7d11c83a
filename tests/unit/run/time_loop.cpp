#include "run/time_loop.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene_text.hpp"
#include "solver/plan.hpp"

namespace tread::run
{
namespace
{

/// A ball without weight that two phases drive. The first is no multiple of the step.
const std::string two_drives = test::steel_text + R"(
[time]
dt = 1.0e-3
[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
diameter = 0.2
mass     = 1.0
position = [2.0, 0.5, 0.5]
[[phase]]
name     = "first"
duration = 0.0105
drive    = { body = "ball", angular_velocity = 2.0 }
[[phase]]
name     = "second"
duration = 0.02
drive    = { body = "ball", angular_velocity = 4.0, ramp = 0.02 }
)";

class TimeLoopTest : public testing::Test
{
protected:
    TimeLoopTest() { simulation_.begin(); }

    double spin() { return spin_of(simulation_.named_bodies().at(0)); }

    Counters                        counters_;
    scene::Scene                    scene_ = test::load_text(two_drives);
    world::World                    world_ = world::build_world(scene_);
    solver::Simulation<Cpu, double> simulation_{Cpu{&counters_}, scene_, world_, solver::make_plan(scene_, world_)};
    TimeLoop<Cpu, double>           loop_{scene_, world_, simulation_};
    LoopCalls                       calls_;
};

TEST_F(TimeLoopTest, RunsThePhasesInOrder)
{
    std::vector<std::string> calls;
    double                   spin_between = 0;
    calls_.phase_ends                     = [&] { calls.push_back(describe(loop_.watch.ending)); };
    calls_.phase_begins                   = [&]
    {
        calls.push_back(keys_of(scene_, loop_.phase).name);
        spin_between = loop_.phase.start_spins.at(0);
        EXPECT_LT(loop_.progress.last_dt, 1e-3) << "the last steps are shortened";
        EXPECT_EQ(loop_.progress.chosen.dt, 1e-3) << "and the next ones are not";
    };
    EXPECT_FALSE(run_phases(loop_, calls_));
    EXPECT_EQ(calls, (std::vector<std::string>{"after 0.0105 s", "second", "after 0.02 s"}));
    EXPECT_NEAR(loop_.progress.time, 0.0305, time_rounding);
    EXPECT_NEAR(spin_between, 2.0, 1e-12);
    EXPECT_NEAR(spin(), 4.0, 1e-12);
}

TEST_F(TimeLoopTest, SkipsPhasesThatEndEarly)
{
    calls_.early_end = [&]() -> std::optional<PhaseEnd>
    {
        if (loop_.progress.steps < 3) { return {}; }
        return PhaseEnd{EndKind::end_of_bed, loop_.progress.time - loop_.phase.start};
    };
    int begun           = 0;
    calls_.phase_begins = [&] { ++begun; };
    EXPECT_FALSE(run_phases(loop_, calls_));
    EXPECT_EQ(begun, 1);
    EXPECT_EQ(loop_.progress.steps, 3);
    EXPECT_EQ(loop_.watch.ending.kind, EndKind::end_of_bed);
    EXPECT_EQ(loop_.watch.ending.after, 0);
}

TEST_F(TimeLoopTest, StopsForAReasonAndAdjustsCommands)
{
    calls_.reason_to_stop = [&]
    { return loop_.progress.steps == 3 ? std::optional<std::string>("enough") : std::nullopt; };
    calls_.adjust = [](std::vector<solver::BodyCommand>& commands) { commands.at(0).spin = 7; };
    EXPECT_EQ(run_phases(loop_, calls_), "enough");
    EXPECT_EQ(loop_.progress.steps, 3);
    EXPECT_NEAR(spin(), 7.0, 1e-12);
}

} // namespace
} // namespace tread::run
