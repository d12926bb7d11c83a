#include "solver/bodies/motion_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace tread::solver
{
namespace
{

/// Step over sqrt(m / k) of a carriage: its frequency is then wrong by (0.1)^2 / 24.
constexpr double spring_share = 0.1;

/// Largest magnitude of a force or torque.
double largest(const scene::AxisMotion& axis)
{
    if (axis.kind != scene::AxisKind::effort) { return 0; }
    double most = std::max(std::abs(axis.course.value), std::abs(axis.course.from.value_or(0)));
    if (!axis.course.table) { return most; }
    for (const double value : axis.course.table->value) { most = std::max(most, std::abs(value)); }
    return most;
}

double sum_of(const std::array<scene::AxisMotion, 3>& axes)
{
    double sum = 0;
    for (const scene::AxisMotion& axis : axes) { sum += largest(axis); }
    return sum;
}

/// Bounds of one motion of named body `b`.
MotionBounds bounds_of(const scene::Motion& motion, const world::World& world, std::size_t b)
{
    double force = sum_of(motion.translation);
    if (motion.load) { force += largest({scene::AxisKind::effort, *motion.load}); }
    MotionBounds bounds;
    if (motion.carriage)
    {
        const double radius = world.bodies.scale[b] * world::template_of(world, b).bounding_radius;
        const double away   = std::abs(world.bodies.position[b][2] - motion.carriage->height) + radius;
        force += motion.carriage->stiffness * away;
        bounds.longest_step = spring_share * std::sqrt(world.bodies.mass[b] / motion.carriage->stiffness);
    }
    bounds.acceleration = acceleration_by(world, b, force, sum_of(motion.rotation) + largest(motion.axle));
    return bounds;
}

} // namespace

double acceleration_by(const world::World& world, std::size_t body, double force, double torque)
{
    const double       mass = world.bodies.mass[body], scale = world.bodies.scale[body];
    const auto&        form    = world::template_of(world, body);
    const Mat3<double> inertia = mass / form.unit.volume * scale * scale * form.unit.inertia;
    return force / mass + scale * form.bounding_radius * torque * inertia.inverse().norm();
}

MotionBounds motion_bounds(const scene::Scene& scene, const world::World& world)
{
    MotionBounds all;
    for (const scene::Phase& phase : scene.phases)
    {
        for (const scene::Motion& motion : phase.motion)
        {
            for (std::size_t b = 0; b < scene.bodies.size(); ++b)
            {
                if (scene.bodies[b].name != motion.body) { continue; }
                const MotionBounds one = bounds_of(motion, world, b);
                all.acceleration       = std::max(all.acceleration, one.acceleration);
                all.longest_step       = std::min(all.longest_step, one.longest_step);
            }
        }
    }
    return all;
}

} // namespace tread::solver
