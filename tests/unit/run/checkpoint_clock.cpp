#include "run/checkpoint_clock.hpp"

#include <gtest/gtest.h>

#include "mpi_session.hpp"

// Limits are hours away or already exceeded, so that no result depends on the speed of this machine.
namespace tread::run
{
namespace
{

constexpr double hour = 3600; // s

scene::CheckpointOptions never()
{
    scene::CheckpointOptions options;
    options.every_wall = 0;
    return options;
}

Interruption check(CheckpointClock& clock, double time = 0, std::int64_t step = 0)
{
    return clock.check(test::world(), time, step);
}

TEST(CheckpointClock, WithoutALimitNothingStops)
{
    CheckpointClock    clock(never(), 0, wall_clock() - 100 * hour, 0, 0);
    const Interruption asked = check(clock, 1e6, 1000000);
    EXPECT_FALSE(asked.write || asked.stop);
}

TEST(CheckpointClock, ALimitThatIsOverStopsAfterACheckpoint)
{
    CheckpointClock    clock(never(), hour, wall_clock() - 2 * hour, 0, 0);
    const Interruption asked = check(clock);
    EXPECT_TRUE(asked.write && asked.stop);
    EXPECT_EQ(asked.why, "the wall-time limit");
}

TEST(CheckpointClock, TheLimitLeavesTwiceWhatACheckpointTakes)
{
    CheckpointClock clock(never(), 10 * hour, wall_clock(), 0, 0);
    EXPECT_FALSE(check(clock).stop);
    clock.written(0, 0, 4 * hour);
    EXPECT_FALSE(check(clock).stop);
    clock.written(0, 0, 6 * hour);
    EXPECT_TRUE(check(clock).stop);
}

TEST(CheckpointClock, AFurtherSourceStopsIt)
{
    bool            stop = false;
    CheckpointClock clock(never(), 0, wall_clock(), 0, 0);
    clock.set_stop_source([&] { return stop; });
    EXPECT_FALSE(check(clock).stop);
    EXPECT_FALSE(clock.check_within_step(test::world()));
    stop                     = true;
    const Interruption asked = check(clock);
    EXPECT_TRUE(asked.write && asked.stop);
    EXPECT_EQ(asked.why, "the calling program");
    EXPECT_EQ(clock.check_within_step(test::world()), "the calling program");
}

TEST(CheckpointClock, BeforeTheFirstItExpectsWhatItsBytesTake)
{
    constexpr std::int64_t hundred_megabytes = 100000000;
    CheckpointClock        clock(never(), 10 * hour, wall_clock(), 0, 0);
    clock.expect(hundred_megabytes * 4 * 3600);
    EXPECT_FALSE(check(clock).stop);
    clock.expect(hundred_megabytes * 6 * 3600);
    EXPECT_TRUE(check(clock).stop);
}

TEST(CheckpointClock, StepsAndSimulatedTimeCountFromTheLast)
{
    scene::CheckpointOptions options = never();
    options.every_steps              = 10;
    options.every_time               = 1;
    CheckpointClock clock(options, 0, wall_clock(), 5.0, 100);
    EXPECT_FALSE(check(clock, 5.9, 109).write);
    EXPECT_TRUE(check(clock, 5.9, 110).write);
    EXPECT_TRUE(check(clock, 6.0, 101).write);
    clock.written(6.0, 110, 0);
    EXPECT_FALSE(check(clock, 6.9, 119).write);
    EXPECT_TRUE(check(clock, 6.9, 120).write);
    EXPECT_FALSE(check(clock, 6.9, 120).stop);
}

TEST(CheckpointClock, WallTimeIsDueAtOnceWhenItsIntervalIsOver)
{
    scene::CheckpointOptions options = never();
    options.every_wall               = 1e-9;
    CheckpointClock clock(options, 0, wall_clock(), 0, 0);
    EXPECT_TRUE(check(clock).write);
}

} // namespace
} // namespace tread::run
