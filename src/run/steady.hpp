#pragma once

#include <cstddef>
#include <optional>
#include <vector>

// Detects where a fluctuating series has become steady, and computes its mean from there on, by the rule of
// postprocess/tread_post/steady.py.
namespace tread::run
{

/// If not steady, means are over the last half and are only indicative.
struct SteadyPart
{
    double start; ///< s, time of the first row
    bool   is_steady;
};

/// Least number of finite values that can be judged.
constexpr std::size_t fewest_steady_rows = 20;

/// Finds the steady part of a series; values that are not finite are left out. The transient is cut where the standard
/// error of the remainder is least (MSER: K. P. White, Simulation 69, 1997), with at least 0.4 of the series
/// remaining; the remainder must have no trend. Empty for a series too short to judge.
std::optional<SteadyPart> steady_part(const std::vector<double>& time, const std::vector<double>& values);

/// Statistics of the finite values of a series; NaN where there are none.
struct Moments
{
    double mean;
    double deviation; ///< standard deviation
    double error; ///< standard error of the mean, from the means of eight parts in turn; NaN for fewer than 8 values
};

Moments moments(const std::vector<double>& values);

} // namespace tread::run
