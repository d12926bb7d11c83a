#include "run/answers_so_far.hpp"

#include <gtest/gtest.h>

namespace tread::run
{
namespace
{

/// A wheel that is lowered from 0 s on and driven towards -x from 1 s on, with a ramp of 0.5 s.
scene::Scene lowered_and_driven()
{
    scene::Scene scene;
    scene.bodies.resize(2);
    scene.bodies[0].name = "plate";
    scene.bodies[1].name = "wheel";
    scene.phases.resize(2);
    scene.phases[0].lower = scene::Lower{"wheel", 0.1};
    scene.phases[1].drive = scene::Drive{"wheel", -2.0, 0.5, {}};
    return scene;
}

/// The plate, then the wheel, 0.02 m deep.
std::vector<solver::BodyRow> rows(double force)
{
    std::vector<solver::BodyRow> bodies(2);
    bodies[1].force   = Vec3<double>(force, 0, 0);
    bodies[1].surface = 0.1;
    bodies[1].lowest  = 0.08;
    return bodies;
}

TEST(AnswersSoFar, are_those_of_the_wheel_after_the_ramp)
{
    const scene::Scene scene = lowered_and_driven();
    RunningPhase       phase = first_phase(scene);
    AnswersSoFar       answers;
    EXPECT_FALSE(answers.sinkage);
    answers.add(scene, phase, 1.0, rows(1000));
    EXPECT_FALSE(answers.pull());
    EXPECT_NEAR(answers.sinkage.value(), 0.02, 1e-15);

    enter_next(phase, 1.0, {0, 0});
    answers.add(scene, phase, 1.25, rows(1000));
    answers.add(scene, phase, 1.5, rows(1000));
    EXPECT_FALSE(answers.pull()) << "its span lies in the ramp";
    answers.add(scene, phase, 2.0, rows(-40));
    answers.add(scene, phase, 3.5, rows(-80));
    EXPECT_DOUBLE_EQ(answers.pull().value(), (0.5 * 40 + 1.5 * 80) / 2) << "in the direction of the drive";

    enter_next(phase, 3.5, {0, 0});
    answers.add(scene, phase, 3.5, rows(0));
    EXPECT_FALSE(answers.pull()) << "no phase runs";
    EXPECT_FALSE(answers.sinkage);
}

} // namespace
} // namespace tread::run
