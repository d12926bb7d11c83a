#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "run/phase_commands.hpp"
#include "run/phase_end.hpp"
#include "solver/simulation.hpp"

// The loop over time and phases, which programs and tests share.
namespace tread::run
{

/// Progress of a run.
struct RunProgress
{
    double           time     = 0; ///< s simulated
    std::int64_t     steps    = 0;
    std::int64_t     substeps = 0;
    double           last_dt  = 0; ///< s, length of the last step
    solver::TimeStep chosen;       ///< step within the limits, before the end of a phase or a command shortens it
};

/// State of a loop over the phases of a scene. `scene` and `simulation` must outlive it.
template<class Exec, class Real>
struct TimeLoop
{
    TimeLoop(const scene::Scene& run_scene, const world::World& world, solver::Simulation<Exec, Real>& run_simulation);

    const scene::Scene&              scene;
    solver::Simulation<Exec, Real>&  simulation;
    std::vector<double>              rolling_radii; ///< m, of the named bodies
    RunningPhase                     phase;
    PhaseEndWatch                    watch;
    RunProgress                      progress;
    solver::StageClock               clock;
    std::vector<solver::BodyCommand> commands; ///< of the present step
};

/// Calls that a loop makes; each may be empty.
struct LoopCalls
{
    std::function<std::optional<std::string>()>            reason_to_stop; ///< before a step; a reason ends the loop
    std::function<void(std::vector<solver::BodyCommand>&)> adjust; ///< changes the commands of a step, by named body
    std::function<void(const solver::TimeStep&)>           before_step; ///< the step is chosen
    std::function<void()>                                  after_step;
    std::function<std::optional<PhaseEnd>()>               early_end;    ///< ends the phase whatever its keys say
    std::function<void()>                                  phase_ends;   ///< loop.watch.ending says how
    std::function<void()>                                  phase_begins; ///< any phase after the first
};

/// Computes one step of the running phase, even if the phase is over. Shortens the last steps before the phase's
/// latest end. Returns the step taken; errors are those of Simulation::step.
template<class Exec, class Real>
solver::TimeStep take_step(TimeLoop<Exec, Real>& loop, const LoopCalls& calls);

/// Enters the next phase if the running one is over, and skips phases that end early at once.
template<class Exec, class Real>
void end_phases(TimeLoop<Exec, Real>& loop, const LoopCalls& calls);

/// Runs all phases that are left; returns the reason if calls.reason_to_stop gave one.
template<class Exec, class Real>
std::optional<std::string> run_phases(TimeLoop<Exec, Real>& loop, const LoopCalls& calls);

} // namespace tread::run
