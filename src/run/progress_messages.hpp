#pragma once

#include <optional>
#include <string>

#include "base/log.hpp"
#include "run/answers_so_far.hpp"
#include "run/time_loop.hpp"

namespace tread::run
{

/// Progress messages of a run so far.
struct ProgressMessages
{
    double       wall;                ///< wall_clock() of the last line
    std::int64_t steps       = 0;     ///< at the last line
    double       time        = 0;     ///< s simulated, at the last line
    bool         warned      = false; ///< a warning of steps over their limits was given in this phase
    double       status_wall = 0;     ///< wall_clock() of the last status
};

/// Logs how far a run is, with recent speeds, where that is due: a line and, on a live terminal, a status.
void log_progress(Log& log, ProgressMessages& messages, const scene::Scene& scene, const RunningPhase& phase,
                  const RunProgress& progress, const AnswersSoFar& answers);

/// Returns a warning of a step over its limits, once a phase.
std::optional<std::string> limit_warning(ProgressMessages& messages, const solver::TimeStep& step, double time,
                                         const solver::PaceLimits& limits, const solver::Pace& pace);

} // namespace tread::run
