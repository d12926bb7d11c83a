#pragma once

#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace tread::test
{

/// Mean of values[first] and all later ones.
inline double mean_of(const std::vector<double>& values, std::size_t first)
{
    return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(first), values.end(), 0.0) /
           static_cast<double>(values.size() - first);
}

/// Standard deviation of values[first] and all later ones.
inline double deviation_of(const std::vector<double>& values, std::size_t first)
{
    const double mean   = mean_of(values, first);
    double       square = 0;
    for (std::size_t i = first; i < values.size(); ++i) { square += (values[i] - mean) * (values[i] - mean); }
    return std::sqrt(square / static_cast<double>(values.size() - first));
}

/// Slope of the linear regression of values over times.
inline double slope_of(const std::vector<double>& times, const std::vector<double>& values)
{
    const double time = mean_of(times, 0), value = mean_of(values, 0);
    double       product = 0, square = 0;
    for (std::size_t i = 0; i < times.size(); ++i)
    {
        product += (times[i] - time) * (values[i] - value);
        square += (times[i] - time) * (times[i] - time);
    }
    return product / square;
}

} // namespace tread::test
