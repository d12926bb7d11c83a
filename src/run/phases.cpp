#include "run/phases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "kernels/dem/bodies.hpp"
#include "solver/state_file.hpp"

namespace tread::run
{

const char* name_of(EndKind kind)
{
    switch (kind)
    {
    case EndKind::running:
        return "running";
    case EndKind::duration:
        return "duration";
    case EndKind::settled:
        return "settled";
    case EndKind::unsettled:
        return "not settled";
    case EndKind::lowered:
        return "lowered";
    case EndKind::unlowered:
        return "not lowered";
    case EndKind::end_of_bed:
        return "end of the bed";
    }
    return "";
}

EndKind end_kind(const std::string& name)
{
    for (const EndKind kind : {EndKind::duration, EndKind::settled, EndKind::unsettled, EndKind::lowered,
                               EndKind::unlowered, EndKind::end_of_bed})
    {
        if (name == name_of(kind)) { return kind; }
    }
    return EndKind::running;
}

bool deserves_warning(EndKind kind)
{
    return kind == EndKind::unsettled || kind == EndKind::unlowered || kind == EndKind::end_of_bed;
}

std::string describe(const PhaseEnd& end)
{
    switch (end.kind)
    {
    case EndKind::settled:
        return fmt::format("settled after {:.4g} s (unbalanced force {:.2g} of the weight)", end.after, end.unbalanced);
    case EndKind::unsettled:
        return fmt::format("NOT settled after its max_duration of {:.4g} s: unbalanced force {:.2g} of the weight, "
                           "wanted {:.2g}",
                           end.after, end.unbalanced, PhaseClock::equilibrium_ratio);
    case EndKind::lowered:
        return fmt::format("the ground carries {:.3g} % of '{}' after {:.4g} s", 100 * end.carried, end.body,
                           end.after);
    case EndKind::unlowered:
        return fmt::format("NOT lowered after its max_duration of {:.4g} s: the ground carries {:.3g} % of '{}'",
                           end.after, 100 * end.carried, end.body);
    case EndKind::end_of_bed:
        return fmt::format("'{}' reached the end of the bed after {:.4g} s: {}", end.body, end.after, end.place);
    case EndKind::duration:
        return fmt::format("after {:.4g} s", end.after);
    case EndKind::running:
        break;
    }
    return fmt::format("runs since {:.4g} s", end.after);
}

void CarriedShare::note(double time, double integral)
{
    const double since = time - last;
    if (last >= 0 && since > 0)
    {
        const double now = (integral - carried) / since;
        share -= std::expm1(-since / span) * (now - share);
    }
    last    = time;
    carried = integral;
}

PhaseClock::PhaseClock(const scene::Scene& scene, std::vector<double> rolling_radii)
    : scene_(scene)
    , rolling_radii_(std::move(rolling_radii))
    , still_since_(std::numeric_limits<double>::infinity())
    , start_spins_(scene.bodies.size(), 0.0)
{
}

double PhaseClock::latest_end() const
{
    const scene::Phase& now = phase();
    return start_ + (now.until == scene::StopRule::duration ? now.duration : now.max_duration);
}

bool PhaseClock::over(double time, double unbalanced)
{
    const scene::Phase& now = phase();
    // A tolerance of half a nanosecond covers the rounding of a sum of steps.
    const bool late = time >= latest_end() - 5e-10;
    ending_         = {EndKind::running, time - start_, unbalanced};
    if (now.until == scene::StopRule::duration)
    {
        if (late) { ending_.kind = EndKind::duration; }
        return late;
    }
    if (now.until == scene::StopRule::lowered)
    {
        ending_.body    = now.lower->body;
        ending_.carried = carried_.share;
        if (ending_.carried >= now.lower->share) { ending_.kind = EndKind::lowered; }
        else if (late) { ending_.kind = EndKind::unlowered; }
        return ending_.kind != EndKind::running;
    }
    if (unbalanced > equilibrium_ratio) { still_since_ = std::numeric_limits<double>::infinity(); }
    else { still_since_ = std::min(still_since_, time); }
    if (time - still_since_ >= equilibrium_hold) { ending_.kind = EndKind::settled; }
    else if (late) { ending_.kind = EndKind::unsettled; }
    return ending_.kind != EndKind::running;
}

void PhaseClock::end_of_bed(double time, double unbalanced, const std::string& place)
{
    ending_ = {EndKind::end_of_bed, time - start_, unbalanced, phase().drive->body, 0, place};
}

void PhaseClock::advance(double time, std::vector<double> spins)
{
    ++index_;
    start_       = time;
    still_since_ = std::numeric_limits<double>::infinity();
    carried_     = {};
    start_spins_ = std::move(spins);
}

std::optional<std::size_t> PhaseClock::lowered() const
{
    const scene::Phase& now = phase();
    if (!now.lower) { return {}; }
    const auto at = std::find_if(scene_.bodies.begin(), scene_.bodies.end(),
                                 [&](const scene::Body& body) { return body.name == now.lower->body; });
    return static_cast<std::size_t>(at - scene_.bodies.begin());
}

/// Lowers along gravity, which may have any direction.
solver::BodyCommand PhaseClock::lower() const
{
    const scene::Vector3& g    = scene_.domain.gravity;
    const double          rate = phase().lower->speed / std::hypot(g[0], g[1], g[2]);
    return {dem::lock_all, 0.0, {}, {{rate * g[0], rate * g[1], rate * g[2]}}};
}

void PhaseClock::transfer(solver::StateFile& file)
{
    const auto last = static_cast<double>(scene_.phases.size()) - 1;
    file.numbers(
        "phases/now", solver::accept::number(index_, 0, last), start_,
        solver::accept::number(still_since_, -solver::accept::largest, std::numeric_limits<double>::infinity()),
        solver::accept::number(ending_.kind, 0, static_cast<double>(EndKind::end_of_bed)), ending_.after,
        ending_.unbalanced);
    file.numbers("phases/carried", carried_.last, carried_.carried, carried_.share);
    file.common("phases/start_spins", start_spins_,
                solver::accept::all(solver::accept::rows(start_spins_.size()), solver::accept::finite()));
}

solver::BodyCommand PhaseClock::command(std::size_t body, double time) const
{
    solver::BodyCommand command = motion(body, time);
    command.weight              = weight(body, time);
    return command;
}

double PhaseClock::weight(std::size_t body, double time) const
{
    const auto& share = phase().weight;
    if (!share || share->body != scene_.bodies[body].name) { return 1; }
    const double done = share->ramp > 0 ? std::min(1.0, (time - start_) / share->ramp) : 1.0;
    return share->from + done * (share->to - share->from);
}

solver::BodyCommand PhaseClock::motion(std::size_t body, double time) const
{
    const scene::Phase& now  = phase();
    const scene::Body&  self = scene_.bodies[body];
    if (std::find(now.hold.begin(), now.hold.end(), self.name) != now.hold.end()) { return {dem::lock_all, 0.0, 0.0}; }
    if (lowered() == body) { return lower(); }
    solver::BodyCommand command{locked_freedoms(self.lock), std::nullopt, std::nullopt};
    if (!now.drive || now.drive->body != self.name) { return command; }
    const scene::Drive& drive = *now.drive;
    const double        share = drive.ramp > 0 ? std::min(1.0, (time - start_) / drive.ramp) : 1.0;
    command.spin              = start_spins_[body] + share * (drive.angular_velocity - start_spins_[body]);
    command.locked |= dem::lock_roll | dem::lock_pitch | dem::lock_yaw;
    if (drive.slip)
    {
        command.forward = (1 - *drive.slip) * *command.spin * rolling_radii_[body];
        command.locked |= dem::lock_x;
    }
    return command;
}

std::uint32_t locked_freedoms(const std::vector<std::string>& words)
{
    static const std::array<std::pair<const char*, std::uint32_t>, 6> bits   = {{{"x", dem::lock_x},
                                                                                 {"y", dem::lock_y},
                                                                                 {"z", dem::lock_z},
                                                                                 {"roll", dem::lock_roll},
                                                                                 {"pitch", dem::lock_pitch},
                                                                                 {"yaw", dem::lock_yaw}}};
    std::uint32_t                                                     locked = 0;
    for (const std::string& word : words)
    {
        for (const auto& [name, bit] : bits)
        {
            if (word == name) { locked |= bit; }
        }
    }
    return locked;
}

double rolling_radius(const scene::Body& body, const shape::ShapeTemplate& form, double scale)
{
    return body.rolling_radius.value_or(scale * (form.is_wheel ? form.wheel.radius : form.equivalent_radius));
}

std::vector<double> rolling_radii(const scene::Scene& scene, const world::World& world)
{
    std::vector<double> radii;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    {
        const auto& form = world.templates[static_cast<std::size_t>(world.bodies.shape[b])];
        radii.push_back(rolling_radius(scene.bodies[b], form, world.bodies.scale[b]));
    }
    return radii;
}

} // namespace tread::run
