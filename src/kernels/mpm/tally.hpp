#pragma once

#include "backend/vector.hpp"

namespace tread::mpm
{

/// A row of a tally: `count` sums over the steps since it was cleared, then the same of the last step alone.
constexpr int tally_width(int count) { return 2 * count; }

/// Books the value of sum `which` of a step.
TREAD_HD void book(double* row, int count, int which, double value)
{
    row[which] += value;
    row[count + which] = value;
}

/// Books more of the same step.
TREAD_HD void book_more(double* row, int count, int which, double value)
{
    row[which] += value;
    row[count + which] += value;
}

} // namespace tread::mpm
