#pragma once

#include <optional>
#include <string>

#include "run/time_loop.hpp"

namespace tread::run
{

/// Progress messages of a run so far.
struct ProgressMessages
{
    double       wall;           ///< wall_clock() of the last message
    std::int64_t steps  = 0;     ///< at the last message
    double       time   = 0;     ///< s simulated, at the last message
    bool         warned = false; ///< a warning of steps over their limits was given in this phase
};

/// Returns a log line with recent speeds if one is due.
std::optional<std::string> progress_message(ProgressMessages& messages, const scene::Scene& scene,
                                            const RunningPhase& phase, const RunProgress& progress);

/// Returns a warning of a step over its limits, once a phase.
std::optional<std::string> limit_warning(ProgressMessages& messages, const solver::TimeStep& step, double time,
                                         const solver::PaceLimits& limits, const solver::Pace& pace);

} // namespace tread::run
