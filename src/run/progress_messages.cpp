#include "run/progress_messages.hpp"

#include <fmt/format.h>

#include "io/progress.hpp"
#include "run/checkpoint_clock.hpp"

namespace tread::run
{

void log_progress(Log& log, ProgressMessages& messages, const scene::Scene& scene, const RunningPhase& phase,
                  const RunProgress& progress, const AnswersSoFar& answers)
{
    constexpr double line_every = 5, status_every = 1; // s of wall time
    const double     now = wall_clock();
    if (now - messages.status_wall < status_every) { return; }
    messages.status_wall      = now;
    const double       passed = now - messages.wall;
    const auto         steps  = static_cast<double>(progress.steps - messages.steps);
    const io::Progress there{keys_of(scene, phase).name,
                             progress.time,
                             latest_end_of_run(scene, phase),
                             progress.steps,
                             steps / passed,
                             (progress.time - messages.time) / passed,
                             progress.chosen.dt,
                             progress.chosen.limit,
                             answers.pull(),
                             answers.sinkage};
    log.status(io::status_line(there, terminal_columns()));
    if (passed < line_every) { return; }
    log.progress(io::progress_line(there));
    messages.wall  = now;
    messages.steps = progress.steps;
    messages.time  = progress.time;
}

std::optional<std::string> limit_warning(ProgressMessages& messages, const solver::TimeStep& step, double time,
                                         const solver::PaceLimits& limits, const solver::Pace& pace)
{
    const auto excess = messages.warned ? std::nullopt : solver::over_limit(step, limits, pace);
    if (!excess) { return {}; }
    messages.warned = true;
    return fmt::format("t = {:.6g} s: {} (said once a phase)", time, *excess);
}

} // namespace tread::run
