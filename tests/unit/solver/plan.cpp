#include <string>

#include <gtest/gtest.h>

#include "scene_text.hpp"
#include "solver/plan.hpp"

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

} // namespace
