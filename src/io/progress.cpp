#include "io/progress.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tread::io
{

std::string clock_text(double seconds)
{
    const auto whole = static_cast<std::int64_t>(std::llround(seconds));
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string progress_line(const Progress& progress)
{
    const bool   under_way = progress.time_per_s > 0;
    const double left      = under_way ? (progress.end_time - progress.time) / progress.time_per_s : 0;
    return fmt::format("{}  t {:.4g} / {:.4g} s  {} steps  {:.4g} steps/s  ETA {}  dt {:.2e} s ({})", progress.phase,
                       progress.time, progress.end_time, progress.steps, progress.steps_per_s,
                       under_way ? clock_text(left) : "?", progress.dt, progress.limit);
}

std::string timing_table(const std::vector<StageReport>& stages, double wall_s)
{
    std::vector<StageReport> ran;
    std::copy_if(stages.begin(), stages.end(), std::back_inserter(ran), [](const StageReport& s) { return s.on; });
    std::stable_sort(ran.begin(), ran.end(),
                     [](const StageReport& a, const StageReport& b) { return a.seconds > b.seconds; });

    std::string text = fmt::format("{:<28} {:>10} {:>11} {:>7}\n", "stage", "calls", "seconds", "share");
    double      rest = wall_s;

    const auto share = [&](double seconds) { return wall_s > 0 ? 100 * seconds / wall_s : 0; };
    for (const StageReport& stage : ran)
    {
        text += fmt::format("{:<28} {:>10} {:>11.3f} {:>6.1f}%\n", stage.name, stage.calls, stage.seconds,
                            share(stage.seconds));
        rest -= stage.seconds;
    }
    text += fmt::format("{:<28} {:>10} {:>11.3f} {:>6.1f}%\n", rest < 0 ? "overlap of stages" : "everything else", "",
                        rest, share(rest));
    for (const StageReport& stage : stages)
    {
        if (!stage.on) { text += fmt::format("left out: {} - {}\n", stage.name, stage.why); }
    }
    return text;
}

} // namespace tread::io
