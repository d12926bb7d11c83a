#include "run/steering.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "kernels/dem/bodies.hpp"
#include "solver/bodies/motion_bounds.hpp"

namespace tread::run
{
namespace
{

Vec3<double> vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

bool prescribes_velocity(const scene::AxisMotion& axis)
{
    return axis.kind == scene::AxisKind::held || axis.kind == scene::AxisKind::velocity;
}

bool is_finite(const BodySteering& wish)
{
    return std::isfinite(wish.spin.value_or(0)) && std::isfinite(wish.forward.value_or(0)) &&
           vector(wish.force).allFinite() && vector(wish.torque).allFinite() && std::isfinite(wish.axle_torque);
}

/// What the phase would need for `wish`; empty if it has it. `motion`: of the body, or null.
std::string lacks(const scene::Motion* motion, const BodySteering& wish)
{
    if (motion == nullptr) { return wish.has_effort() ? "forces and torques need a [[phase.motion]] of the body" : ""; }
    if (wish.spin && !prescribes_velocity(motion->axle))
    {
        return "a spin needs axle = { velocity = ... } or \"held\" in its motion";
    }
    if (wish.forward && !prescribes_velocity(motion->translation[0]))
    {
        return "a forward speed needs x = { velocity = ... } or \"held\" in its motion";
    }
    if (wish.axle_torque != 0 && prescribes_velocity(motion->axle))
    {
        return "a torque about its axle needs an axle whose velocity its motion leaves free";
    }
    return "";
}

} // namespace

void require_steerable(const scene::Scene& scene, const RunningPhase& phase, std::size_t body, const BodySteering& wish)
{
    const scene::Phase& keys   = keys_of(scene, phase);
    const std::string&  name   = scene.bodies[body].name;
    const auto          refuse = [&](const std::string& why)
    { throw InputError(fmt::format("body '{}' in phase '{}': {}", name, keys.name, why)); };

    if (!is_finite(wish)) { refuse("steering by a number that is not finite"); }
    const bool held = std::find(keys.hold.begin(), keys.hold.end(), name) != keys.hold.end();
    if (held || lowered(scene, phase) == body) { refuse("the phase holds or lowers it: it cannot be steered"); }
    const std::string lack = lacks(scene::motion_of(keys, name), wish);
    if (!lack.empty()) { refuse(lack); }
}

void require_steerable(const scene::Joint& joint, const MotorSteering& wish)
{
    const auto refuse = [&](const std::string& why)
    { throw InputError(fmt::format("joint '{}': {}", joint.name, why)); };
    const double most = wish.most_torque.value_or(0);
    if (!joint.motor) { refuse("it has no motor"); }
    if (!std::isfinite(wish.speed))
    {
        refuse(fmt::format("speed = {}; accepted: a finite number of rad/s", wish.speed));
    }
    if (!std::isfinite(most) || most < 0)
    {
        refuse(fmt::format("largest torque = {}; accepted: a finite number of N m, 0 at least", most));
    }
}

void steer(solver::BodyCommand& command, const BodySteering& wish)
{
    if (command.motion)
    {
        dem::Prescribed& motion = *command.motion;
        motion.axle_spin        = wish.spin.value_or(motion.axle_spin);
        motion.velocity[0]      = wish.forward.value_or(motion.velocity[0]);
        motion.force += vector(wish.force);
        motion.torque += vector(wish.torque);
        motion.axle_torque += wish.axle_torque;
        return;
    }
    if (wish.spin)
    {
        command.spin = wish.spin;
        command.locked |= dem::lock_roll | dem::lock_pitch | dem::lock_yaw;
    }
    if (wish.forward)
    {
        command.forward = wish.forward;
        command.locked |= dem::lock_x;
    }
}

double acceleration_by(const world::World& world, std::size_t body, const BodySteering& wish)
{
    return solver::acceleration_by(world, body, vector(wish.force).norm(),
                                   vector(wish.torque).norm() + std::abs(wish.axle_torque));
}

} // namespace tread::run
