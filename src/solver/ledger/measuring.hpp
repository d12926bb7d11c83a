#pragma once

#include "solver/ledger/extremes.hpp"
#include "solver/time_step.hpp"

namespace tread::solver
{

class StateFile;

/// The step that was taken last.
struct LastStep
{
    TimeStep step;
    double   time = 0; ///< s, when it began
};

/// What was measured last, and when it is measured next.
struct Measuring
{
    static constexpr int most_steps = 8; ///< most steps between two measurements

    Pace         pace;           ///< after the last measured step
    Extremes     extremes;       ///< over all measured steps
    double       unbalanced = 1; ///< unbalanced force over weight in the last measured step
    std::int64_t unmeasured = 0; ///< steps since the last measurement
    std::int64_t every      = 1; ///< steps from one measurement to the next
};

/// Number of steps of sand like `step` until the next measurement: no point may move more than half a cell of `spacing`
/// (m). A step over its limits is measured every time.
std::int64_t steps_until_measured(const TimeStep& step, const PaceLimits& limits, const Pace& pace, double spacing);

/// Saves to a checkpoint, or loads. Call when nothing is unmeasured. `damping`: of the phase.
void transfer(StateFile& file, Measuring& measuring, LastStep& last, double& damping);

} // namespace tread::solver
