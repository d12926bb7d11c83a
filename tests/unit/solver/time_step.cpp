#include <cmath>

#include <gtest/gtest.h>

#include "scene_text.hpp"
#include "solver/materials.hpp"
#include "solver/phases.hpp"
#include "solver/time_step.hpp"

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
    PaceLimits bodies_alone;
    bodies_alone.longest = 1;
    EXPECT_DOUBLE_EQ(choose_step(bold, bodies_alone, pace, 0).dt, 10 * 0.4 * 3.1e-4);
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
    EXPECT_NEAR(damping_ratio(0.5), 0.255, 5e-4); // docs/verification.md#restitution
    EXPECT_EQ(damping_ratio(1.0), 0);
    EXPECT_GT(damping_ratio(0.1), damping_ratio(0.9));
}

const std::string drive_text = test::roller_text + R"(
[[phase]]
name  = "drive"
duration = 1.0
drive = { body = "roller", angular_velocity = 2.0, ramp = 0.5, slip = 0.25 }
)";

TEST(Phases, DriveRampsTheSpinAndLocksWhatItPrescribes)
{
    std::string text = drive_text;
    text.replace(text.find("lock     ="), 45, "lock     = [\"y\"]\n");
    text.replace(text.find("name     = \"rest\""), 17, "name     = \"rest\"\nhold = [\"roller\"]");
    const scene::Scene scene = test::load_text(text);
    PhaseClock         clock(scene, {0.1});
    EXPECT_EQ(clock.command(0, 0).locked, dem::lock_all);
    EXPECT_FALSE(clock.over(0.04, 0));
    EXPECT_TRUE(clock.over(0.05, 0));
    clock.advance(0.05, {0.0});
    const BodyCommand half = clock.command(0, 0.05 + 0.25);
    EXPECT_DOUBLE_EQ(half.spin.value(), 1.0);
    EXPECT_DOUBLE_EQ(half.forward.value(), 0.075);
    EXPECT_EQ(half.locked, std::uint32_t(dem::lock_x | dem::lock_y | dem::lock_roll | dem::lock_pitch | dem::lock_yaw));
    EXPECT_DOUBLE_EQ(clock.command(0, 5.0).spin.value(), 2.0);
}

TEST(Phases, EquilibriumMustLast)
{
    const std::string  text = test::sand_text;
    const auto         at   = text.find("duration = 0.05");
    const scene::Scene scene =
        test::load_text(std::string(text).replace(at, 15, "until = \"equilibrium\"\nmax_duration = 1.0"));
    PhaseClock clock(scene, {});
    EXPECT_FALSE(clock.over(0.10, 0.001));
    EXPECT_FALSE(clock.over(0.12, 0.5)); // a break: the wait starts again
    EXPECT_FALSE(clock.over(0.14, 0.001));
    EXPECT_FALSE(clock.over(0.18, 0.001));
    EXPECT_TRUE(clock.over(0.195, 0.001));
    EXPECT_EQ(clock.ending().kind, EndKind::settled);
    EXPECT_DOUBLE_EQ(clock.ending().after, 0.195);
    EXPECT_EQ(describe(clock.ending()), "settled after 0.195 s (unbalanced force 0.001 of the weight)");
    EXPECT_TRUE(clock.over(1.0, 0.5));
    EXPECT_EQ(clock.ending().kind, EndKind::unsettled);
    EXPECT_EQ(clock.ending().unbalanced, 0.5);
}

} // namespace
