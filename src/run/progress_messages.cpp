#include "run/progress_messages.hpp"

#include <fmt/format.h>

#include "io/progress.hpp"
#include "run/checkpoint_clock.hpp"

namespace tread::run
{

std::optional<std::string> progress_message(ProgressMessages& messages, const scene::Scene& scene,
                                            const RunningPhase& phase, const RunProgress& progress)
{
    constexpr double every  = 5; // s of wall time
    const double     now    = wall_clock();
    const double     passed = now - messages.wall;
    if (passed < every) { return {}; }
    const auto         steps = static_cast<double>(progress.steps - messages.steps);
    const io::Progress line{keys_of(scene, phase).name,
                            progress.time,
                            latest_end_of_run(scene, phase),
                            progress.steps,
                            steps / passed,
                            (progress.time - messages.time) / passed,
                            progress.chosen.dt,
                            progress.chosen.limit};
    messages.wall  = now;
    messages.steps = progress.steps;
    messages.time  = progress.time;
    return io::progress_line(line);
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
