#include <cmath>

#include <gtest/gtest.h>

#include "solver/time_step.hpp"
#include "world/materials.hpp"

namespace
{

using namespace tread;
using namespace tread::solver;

PaceLimits sand_limits()
{
    PaceLimits limits;
    limits.spacing    = 0.02;
    limits.wave_speed = 20;
    limits.courant    = 0.6;
    limits.longest    = 1;
    return limits;
}

TEST(TimeStep, IsAtTheTightestLimitAndNamesIt)
{
    const scene::TimeOptions automatic;
    Pace                     pace;
    EXPECT_DOUBLE_EQ(choose_step(automatic, sand_limits(), pace, 0).dt, 0.6 * 0.02 / 20);
    EXPECT_EQ(choose_step(automatic, sand_limits(), pace, 0).limit, "compression wave");
    pace.stiffest_point = 8e6; // k dt^2 / m_p <= 0.5
    EXPECT_DOUBLE_EQ(choose_step(automatic, sand_limits(), pace, 0).dt, 2.5e-4);
    EXPECT_EQ(choose_step(automatic, sand_limits(), pace, 0).limit, "sand-body contact");
    pace.largest_speed = 100; // v dt <= 0.3 h
    EXPECT_DOUBLE_EQ(choose_step(automatic, sand_limits(), pace, 0).dt, 6e-5);
    EXPECT_EQ(choose_step(automatic, sand_limits(), pace, 0).limit, "speed");
}

TEST(TimeStep, GrowsByFivePercentAtMost)
{
    const TimeStep step = choose_step({}, sand_limits(), {}, 1e-4);
    EXPECT_DOUBLE_EQ(step.dt, 1.05e-4);
    EXPECT_EQ(step.limit, "growth");
}

TEST(TimeStep, SubstepsFollowTheStiffestBody)
{
    Pace pace;
    EXPECT_EQ(choose_step({}, sand_limits(), pace, 0).substeps, 1);
    pace.shortest_contact = 3.1e-4; // 0.2 of it is 6.2e-5, dt is 6e-4
    EXPECT_EQ(choose_step({}, sand_limits(), pace, 0).substeps, 10);
    scene::TimeOptions bold;
    bold.contact_share = 0.4;
    EXPECT_EQ(choose_step(bold, sand_limits(), pace, 0).substeps, 5);
}

/// Without sand a step has ten substeps, and up to forty while no body moves by over 2 % of the smallest radius.
TEST(TimeStep, HasMoreSubstepsWhereBodiesLie)
{
    PaceLimits bodies_alone;
    bodies_alone.longest       = 1;
    bodies_alone.smallest_body = 0.01;
    Pace pace;
    pace.shortest_contact = 1e-3;
    const double substep  = 0.2 * 1e-3;
    EXPECT_DOUBLE_EQ(choose_step({}, bodies_alone, pace, 0).dt, 40 * substep);
    pace.largest_speed = 0.02 * 0.01 / (25 * substep);
    EXPECT_DOUBLE_EQ(choose_step({}, bodies_alone, pace, 0).dt, 25 * substep);
    EXPECT_EQ(choose_step({}, bodies_alone, pace, 0).substeps, 25);
    pace.largest_speed = 1;
    EXPECT_DOUBLE_EQ(choose_step({}, bodies_alone, pace, 0).dt, 10 * substep);
}

TEST(TimeStep, FixedValuesAreTakenAndChecked)
{
    scene::TimeOptions fixed;
    fixed.dt            = 1e-3;
    fixed.substeps      = 7;
    const TimeStep step = choose_step(fixed, sand_limits(), {}, 0);
    EXPECT_EQ(step.dt, 1e-3);
    EXPECT_EQ(step.substeps, 7);
    EXPECT_NE(over_limit(step, sand_limits(), {}).value_or("").find("Courant"), std::string::npos);
    EXPECT_FALSE(over_limit({5e-4, 1, ""}, sand_limits(), {}).has_value());
    Pace deep;
    deep.overlap = 0.2;
    EXPECT_NE(over_limit({5e-4, 1, ""}, sand_limits(), deep).value_or("").find("overlap"), std::string::npos);
}

TEST(TimeStep, LastStepsOfAPhaseAreNeverTiny)
{
    double time = 0, smallest = 1;
    while (1.0 - time > 1e-12)
    {
        const double dt = fitted(0.0301, 1.0 - time);
        smallest        = std::min(smallest, dt);
        time += dt;
    }
    EXPECT_NEAR(time, 1.0, 1e-12);
    EXPECT_GT(smallest, 0.5 * 0.0301);
}

TEST(DampingRatio, IsTheOneOfTheRestitution)
{
    EXPECT_NEAR(world::damping_ratio(0.5), 0.255, 5e-4); // docs/verification.md#restitution
    EXPECT_EQ(world::damping_ratio(1.0), 0);
    EXPECT_GT(world::damping_ratio(0.1), world::damping_ratio(0.9));
}

} // namespace
