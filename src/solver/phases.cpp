#include "solver/phases.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "kernels/dem/bodies.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{

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
    case EndKind::duration:
        return fmt::format("after {:.4g} s", end.after);
    case EndKind::running:
        break;
    }
    return fmt::format("runs since {:.4g} s", end.after);
}

PhaseClock::PhaseClock(const scene::Scene& scene)
    : scene_(scene)
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
    // Half a nanosecond forgives the rounding of a sum of steps.
    const bool late = time >= latest_end() - 5e-10;
    ending_         = {EndKind::running, time - start_, unbalanced};
    if (now.until == scene::StopRule::duration)
    {
        if (late) { ending_.kind = EndKind::duration; }
        return late;
    }
    if (unbalanced > equilibrium_ratio) { still_since_ = std::numeric_limits<double>::infinity(); }
    else { still_since_ = std::min(still_since_, time); }
    if (time - still_since_ >= equilibrium_hold) { ending_.kind = EndKind::settled; }
    else if (late) { ending_.kind = EndKind::unsettled; }
    return ending_.kind != EndKind::running;
}

void PhaseClock::advance(double time, std::vector<double> spins)
{
    ++index_;
    start_       = time;
    still_since_ = std::numeric_limits<double>::infinity();
    start_spins_ = std::move(spins);
}

void PhaseClock::transfer(StateFile& file)
{
    file.numbers("phases/now", index_, start_, still_since_, ending_.kind, ending_.after, ending_.unbalanced);
    file.common("phases/start_spins", start_spins_);
}

BodyCommand PhaseClock::command(std::size_t body, double time) const
{
    const scene::Phase& now  = phase();
    const scene::Body&  self = scene_.bodies[body];
    if (std::find(now.hold.begin(), now.hold.end(), self.name) != now.hold.end()) { return {dem::lock_all, 0.0, 0.0}; }
    BodyCommand command{locked_freedoms(self.lock), std::nullopt, std::nullopt};
    if (!now.drive || now.drive->body != self.name) { return command; }
    const scene::Drive& drive = *now.drive;
    const double        share = drive.ramp > 0 ? std::min(1.0, (time - start_) / drive.ramp) : 1.0;
    command.spin              = start_spins_[body] + share * (drive.angular_velocity - start_spins_[body]);
    command.locked |= dem::lock_roll | dem::lock_pitch | dem::lock_yaw;
    if (drive.slip)
    {
        command.forward = (1 - *drive.slip) * *command.spin; // times the rolling radius, which the caller knows
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

} // namespace tread::solver
