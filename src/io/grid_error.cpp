#include "io/grid_error.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tread::io
{
namespace
{

/// Formats a magnitude to two digits, "180".
std::string rounded(double value)
{
    if (value == 0 || !std::isfinite(value)) { return fmt::format("{}", value); }
    const double digit = std::pow(10, std::floor(std::log10(std::abs(value))) - 1);
    return fmt::format("{:.6g}", std::round(std::abs(value) / digit) * digit);
}

} // namespace

std::string grid_error_line(const GridError& error, const std::optional<DriveMeans>& means)
{
    const auto answer = [&](const char* name, double mean, double size, const char* unit, const std::string& share)
    {
        if (!means) { return fmt::format("{} about {}", name, share); }
        return fmt::format("{} {:.3g} {}, error of the grid about {} {} ({})", name, mean, unit, rounded(size), unit,
                           share);
    };
    const DriveMeans  mean  = means.value_or(DriveMeans{});
    const std::string pull  = fmt::format("{:.2g} % of the load, first order", 100 * error.pull);
    const auto        share = [](double relative) { return fmt::format("{:.2g} %", 100 * relative); };
    const std::string first = means ? answer("pull", mean.pull, error.pull * error.load, "N", pull)
                                    : fmt::format("pull about {} N ({})", rounded(error.pull * error.load), pull);
    return first + "; " + answer("torque", mean.torque, error.torque * mean.torque, "N m", share(error.torque)) + "; " +
           answer("sinkage", mean.sinkage, error.sinkage * mean.sinkage, "m", share(error.sinkage));
}

} // namespace tread::io
