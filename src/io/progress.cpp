#include "io/progress.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace tread::io
{
namespace
{

std::string time_text(const Progress& progress)
{
    return fmt::format("t {:.4g} / {:.4g} s", progress.time, progress.end_time);
}

std::string eta_text(const Progress& progress)
{
    if (progress.time_per_s <= 0) { return "ETA ?"; }
    return "ETA " + clock_text((progress.end_time - progress.time) / progress.time_per_s);
}

std::string speed_text(const Progress& progress) { return fmt::format("{:.4g} steps/s", progress.steps_per_s); }

std::string step_text(const Progress& progress) { return fmt::format("dt {:.2e} s ({})", progress.dt, progress.limit); }

std::vector<std::string> answer_texts(const Progress& progress)
{
    std::vector<std::string> texts;
    if (progress.pull) { texts.push_back(fmt::format("pull {:.3g} N", *progress.pull)); }
    if (progress.sinkage) { texts.push_back(fmt::format("sinkage {:.3g} m", *progress.sinkage)); }
    return texts;
}

/// Share of the simulated time as a bar of 20 letters, and in percent.
std::string bar_text(const Progress& progress)
{
    constexpr int length = 20;
    const double  share  = progress.end_time > 0 ? std::clamp(progress.time / progress.end_time, 0.0, 1.0) : 0.0;
    const auto    full   = static_cast<std::size_t>(length * share);
    return fmt::format("[{}{}] {:.0f} %", std::string(full, '#'), std::string(length - full, '-'),
                       std::floor(100 * share));
}

} // namespace

std::string clock_text(double seconds)
{
    const auto whole = static_cast<std::int64_t>(std::llround(seconds));
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string progress_line(const Progress& progress)
{
    std::vector<std::string> parts = {
        progress.phase,       time_text(progress), fmt::format("{} steps", progress.steps),
        speed_text(progress), eta_text(progress),  step_text(progress)};
    for (std::string& answer : answer_texts(progress)) { parts.push_back(std::move(answer)); }
    return fmt::format("{}", fmt::join(parts, "  "));
}

std::string status_line(const Progress& progress, int columns)
{
    std::vector<std::string> parts = answer_texts(progress);
    parts.insert(parts.begin(), {progress.phase, time_text(progress), eta_text(progress)});
    parts.insert(parts.end(), {step_text(progress), speed_text(progress)});
    std::string line = bar_text(progress);
    for (const std::string& part : parts)
    {
        // A line that fills the last column would wrap.
        if (line.size() + 2 + part.size() < static_cast<std::size_t>(columns)) { line += "  " + part; }
    }
    return line;
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
