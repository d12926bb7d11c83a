#include "run/steady.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace
{

using namespace tread;
using namespace tread::run;

struct Sample
{
    std::vector<double> time, values;
};

/// 10 + transient e^(-t/tau) + rise t + noise, over 10 s.
Sample sample(std::size_t count, double transient, double tau, double rise, double noise)
{
    Random random(11);
    Sample made;
    for (std::size_t i = 0; i < count; ++i)
    {
        const double t = 10 * static_cast<double>(i) / static_cast<double>(count);
        made.time.push_back(t);
        made.values.push_back(10 + transient * std::exp(-t / tau) + rise * t + noise * random.uniform(-1, 1));
    }
    return made;
}

TEST(Steady, CutsTheTransient)
{
    const Sample made = sample(400, 20, 0.5, 0, 0.5);
    const auto   part = steady_part(made.time, made.values);
    ASSERT_TRUE(part);
    EXPECT_TRUE(part->is_steady);
    EXPECT_GT(part->start, 1.0) << "20 e^-2 is 2.7, over the noise of 0.5";
    EXPECT_LT(part->start, 4.0);
}

TEST(Steady, ARiseIsNotSteady)
{
    const Sample made = sample(400, 0, 1, 1, 0.5);
    const auto   part = steady_part(made.time, made.values);
    ASSERT_TRUE(part);
    EXPECT_FALSE(part->is_steady);
    EXPECT_NEAR(part->start, 5, 0.05) << "the last half";
}

TEST(Steady, AFewRowsCannotBeJudged)
{
    const Sample made = sample(fewest_steady_rows - 1, 0, 1, 0, 0.5);
    EXPECT_FALSE(steady_part(made.time, made.values));
}

TEST(Steady, LeavesOutWhatIsNotFinite)
{
    Sample made = sample(100, 0, 1, 0, 0.5);
    for (std::size_t i = 0; i < 100; i += 2) { made.values[i] = std::nan(""); }
    const auto part = steady_part(made.time, made.values);
    ASSERT_TRUE(part);
    EXPECT_TRUE(part->is_steady);
    EXPECT_TRUE(std::isfinite(moments(made.values).mean));
}

/// Values 0 to 15: the parts are pairs, whose means 0.5, 2.5 ... 14.5 have a standard deviation of sqrt(24).
TEST(Steady, MomentsAreThoseOfTheTextbook)
{
    std::vector<double> values(16);
    for (std::size_t i = 0; i < 16; ++i) { values[i] = static_cast<double>(i); }
    const Moments found = moments(values);
    EXPECT_NEAR(found.mean, 7.5, 1e-12);
    EXPECT_NEAR(found.deviation, std::sqrt(255.0 / 12), 1e-12);
    EXPECT_NEAR(found.error, std::sqrt(24.0 / 8), 1e-12);
    EXPECT_TRUE(std::isnan(moments({}).mean));
}

} // namespace
