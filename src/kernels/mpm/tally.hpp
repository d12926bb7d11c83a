#pragma once

#include "backend/vector.hpp"

namespace tread::mpm
{

/// Width of a tally row: `count` sums over the steps since it was cleared, followed by the same sums of the last step
/// alone.
constexpr int tally_width(int count) { return 2 * count; }

/// Adds the value of sum `which` of a new step.
TREAD_HD void add_to_new_step(double* row, int count, int which, double value)
{
    row[which] += value;
    row[count + which] = value;
}

/// Adds to the value of the same step.
TREAD_HD void add_to_same_step(double* row, int count, int which, double value)
{
    row[which] += value;
    row[count + which] += value;
}

} // namespace tread::mpm
