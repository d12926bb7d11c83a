#pragma once

#include <cstddef>
#include <optional>
#include <vector>

// Where a fluctuating series has become steady, and its mean from there on: the rule of
// postprocess/tread_post/steady.py.
namespace tread::run
{

/// Where not steady, means are over the last half and say only what it was like.
struct SteadyPart
{
    double start; ///< s, first row
    bool   is_steady;
};

/// Fewest finite values that can be judged.
constexpr std::size_t fewest_steady_rows = 20;

/// Steady part of a series; values that are not finite are left out. The transient is cut where the standard error of
/// what remains is least (MSER: K. P. White, Simulation 69, 1997), at least 0.4 of the series remaining; what remains
/// must be without trend. Nothing for a series too short to judge.
std::optional<SteadyPart> steady_part(const std::vector<double>& time, const std::vector<double>& values);

/// Of the finite ones among some values; NaN where there are none.
struct Moments
{
    double mean;
    double deviation; ///< standard deviation
    double error;     ///< standard error of the mean, from the means of eight parts in turn; NaN of fewer than 8
};

Moments moments(const std::vector<double>& values);

} // namespace tread::run
