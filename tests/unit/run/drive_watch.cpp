#include "run/drive_watch.hpp"

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace tread::run
{
namespace drive_watch_test
{

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double limit    = 1; ///< m, from where the body starts

/// A body that moves towards the limit, checked at intervals.
struct Way
{
    DriveWatch watch;
    double     time     = 0; ///< s
    double     gone     = 0; ///< m
    int        readings = 0;

    /// Returns whether the position was read.
    bool advance(double span, double speed, double distance)
    {
        time += span;
        gone += distance;
        watch.note_speed(time, speed);
        if (!watch.is_due()) { return false; }
        ++readings;
        watch.set_distance_left(limit - gone);
        return true;
    }
};

TEST(DriveWatch, ReadsAtTheFirstCheck)
{
    Way way;
    EXPECT_TRUE(way.advance(0, 0, 0));
    EXPECT_FALSE(way.advance(0.1, 1, 0.1));
    DriveWatch goes_on; // resumed from a checkpoint: its first check is late
    goes_on.note_speed(12, 1);
    EXPECT_TRUE(goes_on.is_due());
}

/// Every check beyond the limit reads the position, as if each check did, however the speed changes, as long as it is
/// at most twice the speed measured before or after.
TEST(DriveWatch, NothingPassesTheLimitUnseen)
{
    std::mt19937 random(7);
    const auto   draw = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
    for (int run = 0; run < 1000; ++run)
    {
        Way          way;
        double       before  = 0;
        const double fastest = draw(0, 0.5);
        way.advance(0, before, 0);
        while (way.gone < limit)
        {
            const double span = draw(0, 0.1), speed = draw(0, 1) < 0.1 ? 10 * fastest : draw(0, fastest);
            const double most = (1 - 1e-9) * 2 * std::max(before, speed) * span; // rounding is not counted as distance
            const bool   read = way.advance(span, speed, draw(0, 1) < 0.5 ? most : draw(0, most));
            ASSERT_TRUE(read || way.gone < limit) << "run " << run << ": " << way.gone << " m";
            before = speed;
        }
    }
}

/// At a steady speed every reading comes after half of the remaining distance: 1000 checks need about log2(1000 / 2)
/// readings, and 2 in the last interval.
TEST(DriveWatch, ReadsSeldom)
{
    Way way;
    way.advance(0, 1, 0);
    for (int check = 0; check < 999; ++check) { way.advance(1e-3, 1, 1e-3); }
    EXPECT_GE(way.readings, 9);
    EXPECT_LE(way.readings, 12);
}

TEST(DriveWatch, ReadsNoMoreWhereNothingLimits)
{
    DriveWatch watch;
    watch.set_distance_left(infinity);
    for (int look = 1; look < 100; ++look)
    {
        watch.note_speed(look, 1e6);
        EXPECT_FALSE(watch.is_due());
    }
    watch.reset();
    EXPECT_TRUE(watch.is_due()) << "another phase has other limits";
}

TEST(DriveWatch, ReadsWhereASpeedIsNoNumber)
{
    DriveWatch watch;
    watch.set_distance_left(1);
    watch.note_speed(1, std::numeric_limits<double>::quiet_NaN());
    EXPECT_TRUE(watch.is_due());
}

} // namespace drive_watch_test
} // namespace tread::run
