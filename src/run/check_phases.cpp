#include "run/check_phases.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/spellings.hpp"

namespace tread::run
{
namespace
{

std::string length_text(const scene::Phase& phase)
{
    if (phase.until == scene::StopRule::duration) { return fmt::format("{:.4g} s", phase.duration); }
    return fmt::format("until {}, at most {:.4g} s", word_of(phase.until), phase.max_duration);
}

std::string way_text(const DriveWay& way, const scene::Drive& drive)
{
    const std::string text = fmt::format("{:.3g} m{}", way.way, drive.slip ? "" : " if it does not slip");
    return std::isfinite(way.to_end) ? text + fmt::format(" of {:.3g} m there are", std::max(0.0, way.to_end)) : text;
}

std::string drive_text(const scene::Phase& phase, std::size_t index, const std::vector<DriveWay>& ways)
{
    const scene::Drive& drive = *phase.drive;
    std::string         text  = fmt::format("'{}' turns at {:.4g} rad/s, {}", drive.body, drive.angular_velocity,
                                   drive.slip ? fmt::format("slip {:.4g}", *drive.slip) : std::string("slip free"));
    const auto way = std::find_if(ways.begin(), ways.end(), [&](const DriveWay& one) { return one.phase == index; });
    return way == ways.end() ? text : text + ": " + way_text(*way, drive);
}

/// What happens in a phase beside time passing.
std::vector<std::string> doings(const scene::Phase& phase, std::size_t index, const std::vector<DriveWay>& ways)
{
    std::vector<std::string> texts;
    if (phase.drive) { texts.push_back(drive_text(phase, index, ways)); }
    if (phase.lower)
    {
        texts.push_back(fmt::format("'{}' is lowered at {:.4g} m/s", phase.lower->body, phase.lower->speed));
    }
    if (!phase.hold.empty()) { texts.push_back(fmt::format("'{}' held", fmt::join(phase.hold, "', '"))); }
    for (const scene::Motion& motion : phase.motion) { texts.push_back(fmt::format("'{}' moved", motion.body)); }
    if (!phase.motors.empty()) { texts.push_back(fmt::format("{} motors set", phase.motors.size())); }
    if (phase.gravity) { texts.push_back(fmt::format("gravity [{:.4g}]", fmt::join(*phase.gravity, ", "))); }
    if (!phase.contacts.empty()) { texts.push_back(fmt::format("{} contacts set", phase.contacts.size())); }
    if (phase.mass_scaling) { texts.push_back(fmt::format("mass scaling {:.4g}", *phase.mass_scaling)); }
    if (phase.damping > 0) { texts.push_back(fmt::format("damping {:.4g}", phase.damping)); }
    return texts;
}

} // namespace

std::string phase_lines(const scene::Scene& scene, const std::vector<DriveWay>& ways)
{
    std::size_t widest = 0;
    for (const scene::Phase& phase : scene.phases) { widest = std::max(widest, phase.name.size()); }
    std::string text = "phases:\n";
    for (std::size_t p = 0; p < scene.phases.size(); ++p)
    {
        const scene::Phase& phase = scene.phases[p];
        const auto          done  = doings(phase, p, ways);
        text += fmt::format("  {:<{}}  {}{}{}\n", phase.name, widest, length_text(phase), done.empty() ? "" : "; ",
                            fmt::join(done, "; "));
    }
    return text;
}

} // namespace tread::run
