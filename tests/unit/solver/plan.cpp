#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "mpi_session.hpp"
#include "scene_text.hpp"
#include "solver/simulation.hpp"

// Stages of a scene, and their reasons. Allocations and launches of parts: left_out.cpp.
namespace
{

using namespace tread;
using namespace tread::solver;
using test::load_text;

TEST(Plan, SaysWhyAStageIsLeftOut)
{
    const scene::Scene scene = load_text(test::sand_text);
    const world::World world = world::build_world(scene);
    for (const Stage& stage : stages(scene, make_plan(scene, world), 1))
    {
        EXPECT_FALSE(stage.why.empty()) << stage.name;
        EXPECT_EQ(stage.on, stage.name == stage::order || stage.name == stage::scatter || stage.name == stage::grid ||
                                stage.name == stage::gather || stage.name == stage::plasticity ||
                                stage.name == stage::measure || stage.name == stage::output ||
                                stage.name == stage::checkpoints)
            << stage.name;
    }
}

const std::string lone_ball = test::steel_text + R"(
[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
diameter = 0.1
mass     = 1.0
position = [2.0, 0.5, 0.5]
[[phase]]
name     = "fly"
duration = 0.1
)";

TEST(Plan, FindsPairsOfALoneBodyOnSeveralRanksOnly)
{
    const scene::Scene scene = load_text(lone_ball);
    const world::World world = world::build_world(scene);
    for (const int ranks : {1, 2})
    {
        for (const Stage& stage : stages(scene, make_plan(scene, world, ranks), ranks))
        {
            if (stage.name != stage::pairs && stage.name != stage::body_contact) { continue; }
            EXPECT_EQ(stage.on, ranks == 2) << stage.name;
            EXPECT_EQ(stage.why == "bodies on several ranks", ranks == 2) << stage.why;
        }
    }
}

TEST(Plan, OfOneRankIsRefusedWithADecomposition)
{
    const scene::Scene         scene = load_text(lone_ball);
    const world::World         world = world::build_world(scene);
    Counters                   counters;
    const Cpu                  cpu{&counters};
    decomp::Decomposition<Cpu> decomposition(test::world(), cpu, {});
    const auto simulate = [&](const Plan& plan) { Simulation<Cpu, double>(cpu, scene, world, plan, &decomposition); };
    EXPECT_THROW(simulate(make_plan(scene, world)), std::logic_error);
}

} // namespace
