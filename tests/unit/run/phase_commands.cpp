#include "run/phase_commands.hpp"

#include <gtest/gtest.h>

#include "kernels/dem/bodies.hpp"
#include "run/phase_end.hpp"
#include "scene_text.hpp"

namespace tread::run
{
namespace
{

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
    RunningPhase       phase = first_phase(scene);
    PhaseEndWatch      watch;
    EXPECT_EQ(command_of(scene, phase, 0, 0.1, 0).locked, dem::lock_all);
    EXPECT_FALSE(is_over(scene, phase, watch, 0.04, 0));
    EXPECT_TRUE(is_over(scene, phase, watch, 0.05, 0));
    enter_next(phase, 0.05, {0.0});
    const solver::BodyCommand half = command_of(scene, phase, 0, 0.1, 0.05 + 0.25);
    EXPECT_DOUBLE_EQ(half.spin.value(), 1.0);
    EXPECT_DOUBLE_EQ(half.forward.value(), 0.075);
    EXPECT_EQ(half.locked, std::uint32_t(dem::lock_x | dem::lock_y | dem::lock_roll | dem::lock_pitch | dem::lock_yaw));
    EXPECT_DOUBLE_EQ(command_of(scene, phase, 0, 0.1, 5.0).spin.value(), 2.0);
}

TEST(Phases, EquilibriumMustLast)
{
    const std::string  text = test::sand_text;
    const auto         at   = text.find("duration = 0.05");
    const scene::Scene scene =
        test::load_text(std::string(text).replace(at, 15, "until = \"equilibrium\"\nmax_duration = 1.0"));
    const RunningPhase phase = first_phase(scene);
    PhaseEndWatch      watch;
    EXPECT_FALSE(is_over(scene, phase, watch, 0.10, 0.001));
    EXPECT_FALSE(is_over(scene, phase, watch, 0.12, 0.5)); // an interruption: the waiting time starts again
    EXPECT_FALSE(is_over(scene, phase, watch, 0.14, 0.001));
    EXPECT_FALSE(is_over(scene, phase, watch, 0.18, 0.001));
    EXPECT_TRUE(is_over(scene, phase, watch, 0.195, 0.001));
    EXPECT_EQ(watch.ending.kind, EndKind::settled);
    EXPECT_DOUBLE_EQ(watch.ending.after, 0.195);
    EXPECT_EQ(describe(watch.ending), "settled after 0.195 s (unbalanced force 0.001 of the weight)");
    EXPECT_TRUE(is_over(scene, phase, watch, 1.0, 0.5));
    EXPECT_EQ(watch.ending.kind, EndKind::unsettled);
    EXPECT_EQ(watch.ending.unbalanced, 0.5);
}

} // namespace
} // namespace tread::run
