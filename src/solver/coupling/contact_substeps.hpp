#pragma once

#include <functional>
#include <optional>
#include <string>

#include "solver/bodies/dem_solver.hpp"
#include "solver/coupling/sand_body_coupling.hpp"
#include "solver/stage_clock.hpp"

namespace tread::solver
{

/// A check that all ranks call together; returns a reason to stop.
using StopCheck = std::function<std::optional<std::string>()>;

/// The parts of a simulation that move in the contact substeps of a step, and how.
template<class Exec, class Real>
struct ContactSubsteps
{
    const Exec&                   exec;
    const Plan&                   plan;
    DemSolver<Exec>&              bodies;
    SandBodyCoupling<Exec, Real>* coupling; ///< null without sand
    double                        damping;  ///< of the phase
    const StopCheck&              why_stop; ///< empty: no check
};

/// Call when the list of pairs was rebuilt, where there is sand: rows may have changed, and a rank learns what its
/// sleeping sand presses rocks with once it has rows for them. Does nothing on one rank. Collective.
template<class Exec, class Real>
void follow_sleepers(DemSolver<Exec>& bodies, SandBodyCoupling<Exec, Real>& coupling);

/// Runs the contact substeps of a step that begins at `time` (s), with pair lists found anew where a body moves too
/// far. StoppedInStep when the check says so.
template<class Exec, class Real>
void run_substeps(const ContactSubsteps<Exec, Real>& parts, const TimeStep& step, double time, const Pace& pace,
                  StageClock& clock);

} // namespace tread::solver
