#pragma once

#include <optional>
#include <string>

namespace tread::io
{

/// Estimated errors of a driven wheel's answers that come from the grid's spacing.
struct GridError
{
    double load    = 0; ///< N, weight of the wheel
    double pull    = 0; ///< of the drawbar pull, over the load
    double torque  = 0; ///< relative
    double sinkage = 0; ///< relative
};

/// Means over the part of a drive that counts.
struct DriveMeans
{
    double pull    = 0; ///< N
    double torque  = 0; ///< N m
    double sinkage = 0; ///< m
};

/// For the log, "pull 154 N, error of the grid about 180 N (18 % of the load, first order); torque ..."; without means
/// the errors alone.
std::string grid_error_line(const GridError& error, const std::optional<DriveMeans>& means);

} // namespace tread::io
