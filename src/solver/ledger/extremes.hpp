#pragma once

#include "kernels/contact/summary.hpp"
#include "solver/time_step.hpp"

namespace tread::solver
{

class StateFile;

/// Worst values over all measurements of a run.
struct Extremes
{
    double courant       = 0; ///< c_p dt/h
    double displacement  = 0; ///< v dt/h
    double spring        = 0; ///< k dt^2/m_p of the stiffest sand-body contact
    double substep       = 0; ///< dt/N over sqrt(m / sum K) of the stiffest body
    double body_overlap  = 0; ///< largest overlap over the smaller radius
    double point_overlap = 0; ///< largest overlap over the point's radius
    double touched       = 0; ///< s, time in which named bodies touched sand
    double touching      = 0; ///< s, integral of the number of touched points over time

    /// Updates from `steps` steps that end with `step`; `pace` was measured after it.
    void note(const TimeStep& step, std::int64_t steps, const PaceLimits& limits, const Pace& pace,
              const contact::Summary& contacts);

    /// Saves to a checkpoint, or loads from it.
    void transfer(StateFile& file);
};

} // namespace tread::solver
