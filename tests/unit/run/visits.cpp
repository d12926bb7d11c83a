#include "run/visits.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mpi_session.hpp"
#include "scene_text.hpp"
#include "solver/plan.hpp"

namespace tread::run
{
namespace
{

using ::testing::HasSubstr;

/// A ball that nothing holds, in two phases of ten steps.
const std::string free_ball = test::steel_text + R"(
[time]
dt = 1.0e-3
[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
diameter = 0.2
mass     = 2.0
position = [2.0, 0.5, 0.5]
[[phase]]
name     = "first"
duration = 0.01
motion   = [{ body = "ball" }]
[[phase]]
name     = "second"
duration = 0.01
)";

class VisitsTest : public testing::Test
{
protected:
    VisitsTest() { simulation_.begin(); }

    /// Runs all phases with a visitor; returns the reason of a stop.
    std::optional<std::string> run(const Visitor& visitor)
    {
        Visits<Cpu, double> visits(test::world(), log_, world_, plan_, visitor, loop_);
        LoopCalls           calls;
        calls.reason_to_stop = [&] { return visits.visit_if_due(); };
        calls.adjust         = [&](std::vector<solver::BodyCommand>& commands) { visits.steer(commands); };
        const auto reason    = run_phases(loop_, calls);
        visits.visit_last();
        return reason;
    }

    Counters                        counters_;
    Log                             log_{test::world(), Terminal::silent};
    scene::Scene                    scene_ = test::load_text(free_ball);
    world::World                    world_ = world::build_world(scene_);
    solver::Plan                    plan_  = solver::make_plan(scene_, world_);
    solver::Simulation<Cpu, double> simulation_{Cpu{&counters_}, scene_, world_, plan_};
    TimeLoop<Cpu, double>           loop_{scene_, world_, simulation_};
};

TEST_F(VisitsTest, ComeAtPhasesSpansAndTheEnd)
{
    std::vector<std::pair<std::string, std::int64_t>> seen;
    Visitor                                           visitor;
    visitor.every_steps = 4;
    visitor.visit       = [&](Visit& visit) -> std::optional<std::string>
    {
        seen.emplace_back(visit.when().phase, visit.when().steps);
        return {};
    };
    EXPECT_FALSE(run(visitor));
    const decltype(seen) expected{{"first", 0},   {"first", 4},   {"first", 8},  {"second", 10},
                                  {"second", 14}, {"second", 18}, {"second", 20}};
    EXPECT_EQ(seen, expected);
}

TEST_F(VisitsTest, AReasonEndsTheRun)
{
    Visitor visitor;
    visitor.visit = [](Visit& visit)
    { return visit.when().steps > 0 ? std::optional<std::string>("seen") : std::nullopt; };
    EXPECT_EQ(run(visitor), "seen");
    EXPECT_EQ(loop_.progress.steps, 10);
}

TEST_F(VisitsTest, ForcesRaiseTheBoundOfAccelerationAndEndWithThePhase)
{
    const double before = simulation_.limits().gravity;
    Visitor      visitor;
    visitor.visit = [](Visit& visit) -> std::optional<std::string>
    {
        if (visit.when().phase == "first") { visit.steer("ball", BodySteering{{}, {}, {6.0, 0, 0}}); }
        return {};
    };
    run(visitor);
    EXPECT_NEAR(simulation_.limits().gravity - before, 3.0, 1e-12) << "m/s2, 6 N on 2 kg";
    EXPECT_NEAR(simulation_.named_bodies()[0].velocity[0], 3.0 * 0.01, 1e-12) << "m/s, over the first phase";
}

TEST_F(VisitsTest, WhatAPhaseDoesNotLetIsRefused)
{
    std::vector<std::string> messages;
    const auto               attempt = [&](const auto& work)
    {
        try
        {
            work();
            messages.emplace_back();
        }
        catch (const InputError& error)
        {
            messages.emplace_back(error.what());
        }
    };
    Visitor visitor;
    visitor.visit = [&](Visit& visit) -> std::optional<std::string>
    {
        attempt([&] { visit.steer("ball", BodySteering{2.0}); });
        attempt([&] { visit.steer("ball", BodySteering{{}, {}, {1, 0, 0}}); });
        attempt([&] { visit.field("points.colour"); });
        return {};
    };
    run(visitor);
    ASSERT_EQ(messages.size(), 9);
    EXPECT_THAT(messages[0], HasSubstr("body 'ball' in phase 'first': a spin needs axle"));
    EXPECT_EQ(messages[1], "");
    EXPECT_THAT(messages[2], HasSubstr("points.colour"));
    EXPECT_EQ(messages[3], "");
    EXPECT_THAT(messages[4], HasSubstr("need a [[phase.motion]]"));
    EXPECT_THAT(messages[6], HasSubstr("the run is over"));
}

TEST_F(VisitsTest, FieldsAreThoseOfTheRun)
{
    Visitor visitor;
    visitor.visit = [&](Visit& visit) -> std::optional<std::string>
    {
        const HostArray place = visit.field("bodies.position").value();
        EXPECT_EQ(place.data, simulation_.rigid().bodies().position.data());
        EXPECT_EQ(std::make_pair(place.rows, place.columns), (std::pair<std::int64_t, std::int64_t>(1, 3)));
        EXPECT_FALSE(visit.field("points.position").has_value()) << "the scene has no sand";
        EXPECT_EQ(visit.body("ball").mass, 2.0);
        return {};
    };
    run(visitor);
}

} // namespace
} // namespace tread::run
