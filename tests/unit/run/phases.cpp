#include "run/phase_commands.hpp"
#include "run/phase_end.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/dem/bodies.hpp"
#include "scene_text.hpp"

namespace tread::run
{
namespace
{

std::string lowered_text(const std::string& gravity, const std::string& lower)
{
    std::string text = test::roller_text;
    text.replace(text.find("[0.0, 0.0, -9.81]"), 17, gravity);
    text.replace(text.find("duration = 0.05"), 15, "until = \"lowered\"\nmax_duration = 1.0\nlower = " + lower);
    return text;
}

constexpr const char* half = R"({ body = "roller", speed = 0.5, share = 0.5 })";

TEST(Lowering, PrescribesTheVelocityAlongATiltedGravity)
{
    const scene::Scene scene = test::load_text(lowered_text("[3.0, 0.0, -4.0]", half));
    const RunningPhase phase = first_phase(scene);
    EXPECT_EQ(lowered(scene, phase), std::size_t{0});
    const solver::BodyCommand command = command_of(scene, phase, 0, 0.1, 0.1);
    EXPECT_EQ(command.locked, std::uint32_t(dem::lock_all));
    EXPECT_EQ(command.spin, 0.0);
    ASSERT_TRUE(command.lowering);
    EXPECT_DOUBLE_EQ((*command.lowering)[0], 0.3);
    EXPECT_DOUBLE_EQ((*command.lowering)[1], 0.0);
    EXPECT_DOUBLE_EQ((*command.lowering)[2], -0.4);
}

TEST(Lowering, EndsWhenTheGroundCarriesTheShare)
{
    const scene::Scene scene = test::load_text(lowered_text("[0.0, 0.0, -9.81]", half));
    const RunningPhase phase = first_phase(scene);
    PhaseEndWatch      watch;
    // The ground carries the full weight from 0.1 s on: the mean over the recent past exceeds one half after span ln 2.
    const double dt = 1e-4, touch = 0.1;
    double       time = 0;
    do {
        time += dt;
        watch.carried.note(time, std::max(0.0, time - touch));
    } while (!is_over(scene, phase, watch, time, 1.0) && time < 0.5);
    EXPECT_NEAR(time, touch + CarriedShare::span * std::log(2.0), 2 * dt);
    EXPECT_EQ(watch.ending.kind, EndKind::lowered);
    EXPECT_NEAR(watch.ending.carried, 0.5, dt / CarriedShare::span);
    EXPECT_EQ(describe(watch.ending).find("the ground carries 50"), 0u) << describe(watch.ending);
    EXPECT_NE(describe(watch.ending).find("of 'roller' after 0.107 s"), std::string::npos);
}

TEST(Lowering, EndsWithAWarningAtItsMaxDuration)
{
    const scene::Scene scene = test::load_text(lowered_text("[0.0, 0.0, -9.81]", half));
    const RunningPhase phase = first_phase(scene);
    PhaseEndWatch      watch;
    EXPECT_DOUBLE_EQ(latest_end(scene, phase), 1.0);
    EXPECT_FALSE(is_over(scene, phase, watch, 0.999, 0));
    EXPECT_TRUE(is_over(scene, phase, watch, 1.0, 0));
    EXPECT_EQ(watch.ending.kind, EndKind::unlowered);
    EXPECT_TRUE(deserves_warning(watch.ending.kind));
    EXPECT_EQ(describe(watch.ending), "NOT lowered after its max_duration of 1 s: the ground carries 0 % of 'roller'");
}

TEST(Phases, EndsHaveNames)
{
    for (const EndKind kind : {EndKind::duration, EndKind::settled, EndKind::unsettled, EndKind::lowered,
                               EndKind::unlowered, EndKind::end_of_bed})
    {
        EXPECT_EQ(end_kind(name_of(kind)), kind);
    }
    EXPECT_STREQ(name_of(EndKind::end_of_bed), "end of the bed");
}

TEST(Phases, WeightGoesOverTheRampAndIsWholeWhereNobodyNamesIt)
{
    std::string text = test::roller_text;
    text += R"(
[[phase]]
name     = "load"
duration = 1.0
weight   = { body = "roller", from = 0.2, to = 1.5, ramp = 0.5 }
)";
    const scene::Scene scene  = test::load_text(text);
    RunningPhase       phase  = first_phase(scene);
    const auto         weight = [&](double time) { return command_of(scene, phase, 0, 0.1, time).weight; };
    EXPECT_EQ(weight(0.01), 1.0);
    enter_next(phase, 0.05, {0.0});
    EXPECT_DOUBLE_EQ(weight(0.05), 0.2);
    EXPECT_DOUBLE_EQ(weight(0.30), 0.85);
    EXPECT_DOUBLE_EQ(weight(0.90), 1.5);
}

} // namespace
} // namespace tread::run
