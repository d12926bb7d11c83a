#pragma once

#include <optional>
#include <string>

namespace tread::io
{

/// Estimated errors of a driven wheel's answers due to the grid spacing.
struct GridError
{
    double load    = 0; ///< N, weight of the wheel
    double pull    = 0; ///< of the drawbar pull, relative to the load
    double torque  = 0; ///< relative
    double sinkage = 0; ///< relative
};

/// Means over the steady part of a drive.
struct DriveMeans
{
    double pull    = 0; ///< N
    double torque  = 0; ///< N m
    double sinkage = 0; ///< m
};

/// Log line, such as "pull 154 N, error of the grid about 180 N (18 % of the load, first order); torque ..."; without
/// means only the errors.
std::string grid_error_line(const GridError& error, const std::optional<DriveMeans>& means);

} // namespace tread::io
