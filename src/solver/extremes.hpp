#pragma once

#include "kernels/contact/summary.hpp"
#include "solver/time_step.hpp"

namespace tread::solver
{

/// What each measuring of a run sees anyway, at its worst so far. Doubles and nothing else: a checkpoint has them.
struct Extremes
{
    double courant       = 0; ///< c_p dt/h
    double travel        = 0; ///< v dt/h
    double spring        = 0; ///< k dt^2/m_p of the stiffest sand-body contact
    double substep       = 0; ///< over sqrt(m / sum K) of the stiffest body
    double body_overlap  = 0; ///< over the smaller radius
    double point_overlap = 0; ///< over the point's radius
    double touched       = 0; ///< s, in which named bodies touched sand
    double touching      = 0; ///< s, times the points that they touched

    /// `steps` steps that end with `step`, which `pace` was measured after.
    void note(const TimeStep& step, std::int64_t steps, const PaceLimits& limits, const Pace& pace,
              const contact::Summary& contacts);
};

} // namespace tread::solver
