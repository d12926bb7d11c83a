#include "run/axle_turn.hpp"

#include <gtest/gtest.h>

namespace tread::run
{
namespace
{

solver::BodyCommand spinning(double spin)
{
    solver::BodyCommand command;
    command.spin = spin;
    return command;
}

/// The mean of a ramp is at its middle, and a jump at the start of the span counts in full.
TEST(AxleTurn, FollowsACommandedSpin)
{
    AxleTurn  ramp, jump;
    const int steps = 100;
    for (int i = 1; i <= steps; ++i)
    {
        add_step(ramp, spinning(4.0 * i / steps), 1e-3);
        add_step(jump, spinning(4.0), 1e-3);
    }
    EXPECT_NEAR(mean_spin(ramp, 4.0), 2.0, 4.0 / steps); // a step has the spin of its end
    EXPECT_DOUBLE_EQ(mean_spin(jump, 4.0), 4.0);
}

TEST(AxleTurn, TakesTheMeanOfBothEndsOfAFreeSpin)
{
    AxleTurn turn;
    turn.spin = 1;
    EXPECT_EQ(mean_spin(turn, 5), 5); // no span yet
    add_step(turn, {}, 0.1);
    EXPECT_DOUBLE_EQ(mean_spin(turn, 5), 3);
    add_step(turn, spinning(6), 0.3);
    EXPECT_DOUBLE_EQ(mean_spin(turn, 5), (0.1 * 3 + 0.3 * 6) / 0.4);
}

TEST(AxleTurn, PowerIsPositiveWhereTheAxleDrives)
{
    AxleTurn turn;
    add_step(turn, spinning(2), 0.1);
    solver::BodyRow row{};
    row.axle             = Vec3<double>(0, 1, 0);
    row.angular_velocity = Vec3<double>(0, 3, 0);
    row.torque           = Vec3<double>(7, -10, 0);
    EXPECT_DOUBLE_EQ(mean_power(turn, row), 20);
}

} // namespace
} // namespace tread::run
