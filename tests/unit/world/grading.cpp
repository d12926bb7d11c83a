#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "world/grading.hpp"

namespace
{

using namespace tread;
using namespace tread::world;

/// Checks mean and mean square of a distribution, from 5e4 draws, against closed forms. The mean of n draws has a
/// standard error of sigma/sqrt(n); 4 of them occur once in 16,000 tests, and the seed is fixed.
void check_moments(const char* name, const scene::Diameter& diameter, double mean, double square, double fourth)
{
    constexpr int draws = 50000;
    Random        random(7);
    double        sum = 0, sum_of_squares = 0;
    for (int i = 0; i < draws; ++i)
    {
        const double d = quantile(diameter, random.uniform());
        ASSERT_GE(d, quantile(diameter, 0));
        ASSERT_LE(d, quantile(diameter, 1));
        sum += d;
        sum_of_squares += d * d;
    }
    const double tolerance        = 4 * std::sqrt((square - mean * mean) / draws);
    const double square_tolerance = 4 * std::sqrt((fourth - square * square) / draws);
    std::cout << name << ": mean " << sum / draws << ", expected " << mean << ", tolerance " << tolerance
              << "; mean square " << sum_of_squares / draws << ", expected " << square << ", tolerance "
              << square_tolerance << '\n';
    EXPECT_NEAR(sum / draws, mean, tolerance);
    EXPECT_NEAR(sum_of_squares / draws, square, square_tolerance);
}

/// k-th moment of density ~ d^-n in [low, high].
double power_moment(double n, double k, double low, double high)
{
    const auto integral = [&](double p) {
        return std::abs(p + 1) < 1e-12 ? std::log(high / low)
                                       : (std::pow(high, p + 1) - std::pow(low, p + 1)) / (p + 1);
    };
    return integral(k - n) / integral(-n);
}

/// k-th moment of exp(normal(ln m, s)) truncated to [low, high]: m^k exp(k^2 s^2 / 2) [Phi(b - k s) - Phi(a - k s)]
/// over [Phi(b) - Phi(a)].
double log_normal_moment(double m, double s, double k, double low, double high)
{
    const auto   phi = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
    const double a = std::log(low / m) / s, b = std::log(high / m) / s;
    return std::pow(m, k) * std::exp(0.5 * k * k * s * s) * (phi(b - k * s) - phi(a - k * s)) / (phi(b) - phi(a));
}

TEST(Grading, MomentsAreThoseOfTheDistributions)
{
    check_moments("uniform", scene::UniformDiameters{1, 3}, 2, 13.0 / 3, (243.0 - 1) / 10);
    for (const double n : {0.0, 1.0, 2.5, 4.0})
    {
        check_moments(("power law " + std::to_string(n)).c_str(), scene::PowerLawDiameters{n, 0.5, 4},
                      power_moment(n, 1, 0.5, 4), power_moment(n, 2, 0.5, 4), power_moment(n, 4, 0.5, 4));
    }
    const auto log_normal = [](double m, double s, double low, double high)
    {
        const auto moment = [&](double k) { return log_normal_moment(m, s, k, low, high); };
        check_moments("log-normal", scene::LogNormalDiameters{m, s, low, high}, moment(1), moment(2), moment(4));
    };
    log_normal(1, 0.4, 0.2, 5);
    log_normal(1, 0.4, 1.5, 2);
    log_normal(1, 0.3, 0.4, 0.7);
}

TEST(Grading, QuantilesRiseFromSmallestToLargest)
{
    for (const scene::Diameter& diameter :
         {scene::Diameter{scene::UniformDiameters{1, 3}}, scene::Diameter{scene::PowerLawDiameters{1 + 1e-12, 1, 3}},
          scene::Diameter{scene::LogNormalDiameters{2, 0.2, 1, 3}},
          scene::Diameter{scene::LogNormalDiameters{0.5, 0.2, 1, 3}}})
    {
        double before = 0;
        for (double u = 0; u <= 1; u += 1.0 / 128)
        {
            EXPECT_GT(quantile(diameter, u), before);
            before = quantile(diameter, u);
        }
        EXPECT_NEAR(quantile(diameter, 0), 1, 1e-9);
        EXPECT_NEAR(quantile(diameter, 1), 3, 1e-9);
    }
}

/// Rocks are drawn largest first, fill the fraction to half a rock, and depend only on the seed.
TEST(Grading, DrawsFillTheFraction)
{
    scene::Rocks rocks;
    rocks.solid_fraction = 0.2;
    rocks.diameter       = scene::PowerLawDiameters{3, 0.01, 0.04};
    rocks.seed           = 5;
    const auto drawn     = draw_rocks(rocks, 0.1, 7);
    double     solids    = 0;
    int        members   = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i)
    {
        if (i > 0) { ASSERT_LE(drawn[i].diameter, drawn[i - 1].diameter); }
        solids += sphere_volume(drawn[i].diameter);
        members |= 1 << drawn[i].member;
    }
    std::cout << drawn.size() << " rocks fill " << solids / 0.1
              << ", expected 0.2, tolerance half the largest rock: " << 0.5 * sphere_volume(0.04) / 0.1 << '\n';
    EXPECT_NEAR(solids, 0.02, 0.5 * sphere_volume(0.04));
    EXPECT_EQ(members, 127) << "seven forms, all drawn";

    rocks.seed = 6;
    EXPECT_NE(draw_rocks(rocks, 0.1, 7).front().diameter, drawn.front().diameter);
    rocks.seed = 5;
    EXPECT_EQ(draw_rocks(rocks, 0.1, 7).front().diameter, drawn.front().diameter);
}

TEST(Grading, FractionsOfTooFewOrTooManyAreRefused)
{
    scene::Rocks rocks;
    rocks.diameter       = 0.1;
    rocks.solid_fraction = 0.1;
    EXPECT_THROW(draw_rocks(rocks, 1e-3, 1), InputError);
    rocks.diameter = 1e-4;
    EXPECT_THROW(draw_rocks(rocks, 1, 1), InputError);
}

/// A total volume that almost certainly exceeds the region's is refused before a rock is drawn; one that may fit is
/// left to the placement.
TEST(Grading, RocksThatAreMoreThanTheirRegionAreRefused)
{
    scene::Rocks rocks;
    rocks.count    = 10'000;
    rocks.diameter = scene::UniformDiameters{0.001, 0.02};
    double solids  = 0;
    for (const RockDraw& rock : draw_rocks(rocks, 1, 1)) { solids += sphere_volume(rock.diameter); }
    EXPECT_EQ(draw_rocks(rocks, 0.99 * solids, 1).size(), 10'000u);
    EXPECT_THROW(draw_rocks(rocks, 0.8 * solids, 1), InputError);
}

} // namespace
