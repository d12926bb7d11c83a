#include "run/phase_commands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kernels/dem/bodies.hpp"
#include "scene/phase_settings.hpp"

namespace tread::run
{
namespace
{

/// Share of a linear ramp of `ramp` (s) that has passed `since` s after its start.
double ramped(double since, double ramp) { return ramp > 0 ? std::min(1.0, since / ramp) : 1.0; }

/// Share of a body's weight that acts.
double weight_share(const scene::Phase& keys, const scene::Body& body, double since)
{
    const auto& share = keys.weight;
    if (!share || share->body != body.name) { return 1; }
    return share->from + ramped(since, share->ramp) * (share->to - share->from);
}

/// Lowers along gravity, which may have any direction.
solver::BodyCommand lowering(const scene::Lower& lower, const scene::Vector3& g)
{
    const double rate = lower.speed / std::hypot(g[0], g[1], g[2]);
    return {dem::lock_all, 0.0, {}, {{rate * g[0], rate * g[1], rate * g[2]}}};
}

/// Adds a drive to the command of a body that had `start_spin` (rad/s) when the phase began.
void add_drive(solver::BodyCommand& command, const scene::Drive& drive, double start_spin, double rolling_radius,
               double since)
{
    command.spin = start_spin + ramped(since, drive.ramp) * (drive.angular_velocity - start_spin);
    command.locked |= dem::lock_roll | dem::lock_pitch | dem::lock_yaw;
    if (!drive.slip) { return; }
    command.forward = (1 - *drive.slip) * *command.spin * rolling_radius;
    command.locked |= dem::lock_x;
}

solver::BodyCommand motion(const scene::Scene& scene, const RunningPhase& phase, std::size_t body,
                           double rolling_radius, double since)
{
    const scene::Phase& keys = keys_of(scene, phase);
    const scene::Body&  self = scene.bodies[body];
    if (std::find(keys.hold.begin(), keys.hold.end(), self.name) != keys.hold.end())
    {
        return {dem::lock_all, 0.0, 0.0};
    }
    if (lowered(scene, phase) == body) { return lowering(*keys.lower, scene::gravity_in(scene, phase.index)); }
    solver::BodyCommand command{locked_freedoms(self.lock), std::nullopt, std::nullopt};
    if (keys.drive && keys.drive->body == self.name)
    {
        add_drive(command, *keys.drive, phase.start_spins[body], rolling_radius, since);
    }
    return command;
}

} // namespace

solver::BodyCommand command_of(const scene::Scene& scene, const RunningPhase& phase, std::size_t body,
                               double rolling_radius, double time)
{
    const double        since   = time - phase.start;
    solver::BodyCommand command = motion(scene, phase, body, rolling_radius, since);
    command.weight              = weight_share(keys_of(scene, phase), scene.bodies[body], since);
    return command;
}

void set_commands(std::vector<solver::BodyCommand>& commands, const scene::Scene& scene, const RunningPhase& phase,
                  const std::vector<double>& rolling_radii, double time)
{
    commands.resize(rolling_radii.size());
    for (std::size_t b = 0; b < commands.size(); ++b)
    {
        commands[b] = command_of(scene, phase, b, rolling_radii[b], time);
    }
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
        const auto& form = world::template_of(world, b);
        radii.push_back(rolling_radius(scene.bodies[b], form, world.bodies.scale[b]));
    }
    return radii;
}

} // namespace tread::run
