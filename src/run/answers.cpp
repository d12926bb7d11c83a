#include "run/answers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "io/h5.hpp"
#include "run/steady.hpp"

namespace tread::run
{
namespace
{

constexpr double rounding = 1e-9; ///< s, tolerance of times

/// Time series of a body: each row is the mean since the row before.
struct History
{
    std::vector<double> time, sinkage, slip, power; ///< [n]
    std::vector<double> force, torque;              ///< [n][3]
};

/// A phase's interval in the time series.
struct Span
{
    std::size_t phase;
    double      start, end; ///< s
};

History read_history(const io::h5::File& file, const std::string& body)
{
    const std::string group = "/wheel/" + body + "/";
    const auto        one   = [&](const char* name) { return io::h5::read<double>(file, group + name, 1); };
    const auto        three = [&](const char* name) { return io::h5::read<double>(file, group + name, 3); };
    return {one("time"), one("sinkage"), one("slip"), one("power"), three("force"), three("torque")};
}

std::vector<Span> read_spans(const io::h5::File& file)
{
    const std::vector<double> index = io::h5::read<double>(file, "/phases/index", 1),
                              start = io::h5::read<double>(file, "/phases/start", 1);
    std::vector<Span> spans;
    for (std::size_t p = 0; p < index.size(); ++p)
    {
        const double end = p + 1 < start.size() ? start[p + 1] : std::numeric_limits<double>::infinity();
        spans.push_back({static_cast<std::size_t>(index[p]), start[p], end});
    }
    return spans;
}

bool drives(const scene::Phase& phase, const std::string& body) { return phase.drive && phase.drive->body == body; }
bool lowers(const scene::Phase& phase, const std::string& body) { return phase.lower && phase.lower->body == body; }
bool holds(const scene::Phase& phase, const std::string& body)
{
    return std::find(phase.hold.begin(), phase.hold.end(), body) != phase.hold.end();
}

/// Selects the phases for which a body's answers are computed.
std::vector<Span> spans_of(const std::string& body, const scene::Scene& scene, const std::vector<Span>& spans)
{
    std::vector<Span>   found;
    std::optional<Span> free;
    for (const Span& span : spans)
    {
        const scene::Phase& phase = scene.phases[span.phase];
        if (drives(phase, body) || lowers(phase, body)) { found.push_back(span); }
        else if (!holds(phase, body)) { free = span; }
    }
    if (found.empty() && free) { found.push_back(*free); }
    return found;
}

/// Indices of the rows whose averaging interval lies within `from` to `to`.
std::vector<std::size_t> rows_within(const std::vector<double>& time, double from, double to)
{
    std::vector<std::size_t> rows;
    for (std::size_t i = 1; i < time.size(); ++i)
    {
        // A row at the time of the one before it averages over nothing.
        const bool within = time[i - 1] >= from - rounding && time[i] <= to + rounding;
        if (within && time[i] - time[i - 1] > rounding) { rows.push_back(i); }
    }
    return rows;
}

std::vector<double> pick(const std::vector<double>& values, const std::vector<std::size_t>& rows, double factor = 1,
                         std::size_t width = 1, std::size_t component = 0)
{
    std::vector<double> picked;
    picked.reserve(rows.size());
    for (const std::size_t row : rows) { picked.push_back(factor * values[width * row + component]); }
    return picked;
}

/// A quantity in summary.json, and its values; `decides`: the answers are steady only if this quantity is.
struct Series
{
    const char*         name;
    const char*         unit;
    bool                decides;
    std::vector<double> values;
};

/// The first two are pull and load.
std::vector<Series> driven_series(const History& history, const std::vector<std::size_t>& rows, double direction)
{
    return {{"pull", "N", true, pick(history.force, rows, direction, 3, 0)},
            {"load", "N", false, pick(history.force, rows, 1, 3, 2)},
            {"torque", "N m", true, pick(history.torque, rows, -direction, 3, 1)},
            {"sinkage", "m", true, pick(history.sinkage, rows)},
            {"slip", "1", false, pick(history.slip, rows)},
            {"power", "W", false, pick(history.power, rows)}};
}

std::vector<Series> standing_series(const History& history, const std::vector<std::size_t>& rows)
{
    return {{"load", "N", false, pick(history.force, rows, 1, 3, 2)},
            {"sinkage", "m", true, pick(history.sinkage, rows)}};
}

double median(std::vector<double> times)
{
    const std::size_t half = times.size() / 2;
    return times.size() % 2 == 1 ? times[half] : 0.5 * (times[half - 1] + times[half]);
}

/// Common averaging interval of all quantities: from where the last of the deciding ones becomes steady, or the last
/// half.
SteadyPart common_part(const std::vector<double>& time, const std::vector<Series>& series)
{
    SteadyPart common{time.front(), true};
    for (const Series& one : series)
    {
        if (!one.decides) { continue; }
        const auto part  = steady_part(time, one.values);
        common.is_steady = common.is_steady && part && part->is_steady;
        if (part) { common.start = std::max(common.start, part->start); }
    }
    if (!common.is_steady) { common.start = median(time); }
    return common;
}

io::PhaseAnswers answers_of(const std::vector<double>& time, const std::vector<Series>& series)
{
    const SteadyPart part  = common_part(time, series);
    const auto       first = std::lower_bound(time.begin(), time.end(), part.start) - time.begin();
    io::PhaseAnswers answers;
    answers.from   = part.start;
    answers.to     = time.back();
    answers.rows   = static_cast<std::int64_t>(time.size()) - first;
    answers.steady = part.is_steady;
    for (const Series& one : series)
    {
        const Moments found = moments({one.values.begin() + first, one.values.end()});
        answers.quantities.push_back({one.name, one.unit, found.mean, found.deviation, found.error, std::nullopt});
    }
    return answers;
}

/// Inserts the share of the mean load behind the pull.
void add_share(std::vector<io::Answer>& quantities)
{
    const io::Answer pull = quantities[0];
    const double     load = quantities[1].mean;
    quantities.insert(quantities.begin() + 1, {"pull_over_load", "1", pull.mean / load, pull.spread / load,
                                               pull.standard_error / load, std::nullopt});
}

/// Removes undefined quantities: a wheel that does not turn has no slip, one without load no share of it.
void leave_out_unknown(std::vector<io::Answer>& quantities)
{
    std::erase_if(quantities, [](const io::Answer& answer) { return !std::isfinite(answer.mean); });
}

std::string text_of(const io::Answer& answer)
{
    std::string text = fmt::format("{} {:.4g}", answer.name, answer.mean);
    if (std::isfinite(answer.standard_error)) { text += fmt::format(" +- {:.2g}", answer.standard_error); }
    return answer.unit == "1" ? text : text + " " + answer.unit;
}

std::string line_of(const std::string& body, const io::PhaseAnswers& phase)
{
    std::string line = fmt::format("answers: {}, {}: ", body, phase.phase);
    for (const io::Answer& answer : phase.quantities)
    {
        if (answer.name == "pull_over_load") { line += fmt::format(" ({:.3g} of the load)", answer.mean); }
        else { line += (line.back() == ' ' ? "" : ", ") + text_of(answer); }
    }
    line += fmt::format("{}{} {:.4g} to {:.4g} s", phase.quantities.empty() ? "" : ", ",
                        phase.steady ? "steady over" : "NOT steady, means over", phase.from, phase.to);
    return phase.ended ? line : line + " (the phase did not end)";
}

/// Answers of the last wheel that the scene drives; null without one.
template<class Answers>
auto* last_driven(const scene::Scene& scene, Answers& answers)
{
    decltype(&answers.front()) found = nullptr;
    for (const scene::Phase& phase : scene.phases)
    {
        for (auto& body : answers)
        {
            if (drives(phase, body.body)) { found = &body; }
        }
    }
    return found;
}

/// Whether these answers belong to a phase that drives the body.
bool is_drive(const scene::Scene& scene, const std::string& body, const io::PhaseAnswers& answers)
{
    return std::any_of(scene.phases.begin(), scene.phases.end(),
                       [&](const scene::Phase& phase) { return phase.name == answers.phase && drives(phase, body); });
}

/// Returns the mean of a quantity, NaN where the answers lack it.
double mean_of(const io::PhaseAnswers& phase, const std::string& name)
{
    const auto found = std::find_if(phase.quantities.begin(), phase.quantities.end(),
                                    [&](const io::Answer& answer) { return answer.name == name; });
    return found == phase.quantities.end() ? std::numeric_limits<double>::quiet_NaN() : found->mean;
}

std::optional<double> error_of(const io::Answer& answer, const io::GridError& error)
{
    if (answer.name == "pull") { return error.pull * error.load; }
    if (answer.name == "pull_over_load") { return error.pull; }
    if (answer.name == "torque") { return error.torque * std::abs(answer.mean); }
    if (answer.name == "sinkage") { return error.sinkage * std::abs(answer.mean); }
    return std::nullopt;
}

} // namespace

std::vector<io::BodyAnswers> make_answers(const scene::Scene& scene, const std::string& path, std::size_t ended)
{
    const io::h5::File           file  = io::h5::File::open(path);
    const std::vector<Span>      spans = read_spans(file);
    std::vector<io::BodyAnswers> all;
    for (const scene::Body& body : scene.bodies)
    {
        const History   history = read_history(file, body.name);
        io::BodyAnswers answers{body.name, {}};
        for (const Span& span : spans_of(body.name, scene, spans))
        {
            const scene::Phase& phase  = scene.phases[span.phase];
            const bool          driven = drives(phase, body.name);
            const auto rows = rows_within(history.time, span.start + (driven ? phase.drive->ramp : 0), span.end);
            if (rows.empty()) { continue; }
            const double direction = driven && phase.drive->angular_velocity < 0 ? -1 : 1;
            auto         one       = answers_of(pick(history.time, rows),
                                  driven ? driven_series(history, rows, direction) : standing_series(history, rows));
            if (driven) { add_share(one.quantities); }
            leave_out_unknown(one.quantities);
            one.phase = phase.name;
            one.ended = span.phase < ended;
            answers.phases.push_back(std::move(one));
        }
        all.push_back(std::move(answers));
    }
    return all;
}

void add_grid_error(const scene::Scene& scene, const io::GridError& error, std::vector<io::BodyAnswers>& answers)
{
    auto* wheel = last_driven(scene, answers);
    if (wheel == nullptr) { return; }
    for (io::PhaseAnswers& phase : wheel->phases)
    {
        if (!is_drive(scene, wheel->body, phase)) { continue; }
        for (io::Answer& answer : phase.quantities) { answer.estimated_error = error_of(answer, error); }
    }
}

std::optional<io::DriveMeans> last_drive(const scene::Scene& scene, const std::vector<io::BodyAnswers>& answers)
{
    const auto* wheel = last_driven(scene, answers);
    if (wheel == nullptr || wheel->phases.empty()) { return std::nullopt; }
    const io::PhaseAnswers& drive = wheel->phases.back();
    if (!is_drive(scene, wheel->body, drive)) { return std::nullopt; }
    return io::DriveMeans{mean_of(drive, "pull"), mean_of(drive, "torque"), mean_of(drive, "sinkage")};
}

std::vector<std::string> answer_lines(const std::vector<io::BodyAnswers>& answers)
{
    std::vector<std::string> lines;
    for (const io::BodyAnswers& body : answers)
    {
        for (const io::PhaseAnswers& phase : body.phases) { lines.push_back(line_of(body.body, phase)); }
    }
    return lines;
}

} // namespace tread::run
