#include "run/motions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "run/phase_commands.hpp"
#include "run/phase_end.hpp"
#include "scene/motion_tables.hpp"
#include "scene/named.hpp"
#include "scene/phase_settings.hpp"
#include "scene/time_table.hpp"
#include "solver/state_file.hpp"

namespace tread::run
{
namespace
{

/// Value of a course `since` s after the phase began; `start`: where a ramp begins that names no start.
double value_of(const scene::Course& course, double start, double since)
{
    if (course.table) { return scene::value_at(*course.table, since); }
    if (!(since < course.ramp)) { return course.value; }
    const double from = course.from.value_or(start);
    return from + since / course.ramp * (course.value - from);
}

bool holds(const scene::AxisMotion& axis)
{
    return axis.kind == scene::AxisKind::held || axis.kind == scene::AxisKind::velocity;
}

/// Velocity of a held axis that had `start` when the phase began.
double held_velocity(const scene::AxisMotion& axis, double start, double since)
{
    return axis.kind == scene::AxisKind::velocity ? value_of(axis.course, start, since) : 0;
}

/// Mean force or torque of an axis in a step.
double effort(const scene::AxisMotion& axis, const StepOfPhase& step)
{
    return axis.kind == scene::AxisKind::effort ? value_of(axis.course, 0, step.end - 0.5 * step.dt) : 0;
}

Vec3<double> efforts(const std::array<scene::AxisMotion, 3>& axes, const Mat3<double>& frame, const StepOfPhase& step)
{
    Vec3<double> sum = Vec3<double>::Zero();
    for (int c = 0; c < 3; ++c) { sum += effort(axes[static_cast<std::size_t>(c)], step) * frame.col(c); }
    return sum;
}

/// Sets the velocities of held axes; returns their bits from `first` on.
std::uint32_t hold_axes(const std::array<scene::AxisMotion, 3>& axes, std::uint32_t first, const Vec3<double>& start,
                        double since, Vec3<double>& velocity)
{
    std::uint32_t held = 0;
    for (int c = 0; c < 3; ++c)
    {
        const scene::AxisMotion& axis = axes[static_cast<std::size_t>(c)];
        if (!holds(axis)) { continue; }
        held |= first << c;
        velocity[c] = held_velocity(axis, start[c], since);
    }
    return held;
}

/// N, what a dead weight adds to the body's own.
Vec3<double> load_force(const scene::Course& load, double mass, const Vec3<double>& gravity, const StepOfPhase& step)
{
    const double       g    = gravity.norm();
    const Vec3<double> down = g > 0 ? Vec3<double>(gravity / g) : Vec3<double>(-Vec3<double>::UnitZ());
    return (value_of(load, mass * g, step.end - 0.5 * step.dt) - mass * g) * down;
}

/// Whether a motion leaves no degree of freedom.
bool is_unyielding(std::uint32_t held)
{
    const std::uint32_t all = (held & dem::hold_axle) != 0 ? held | dem::lock_pitch : held;
    return (all & dem::lock_all) == dem::lock_all;
}

/// Whether all phases before this one hold the body.
bool was_held(const scene::Scene& scene, std::size_t phase, const std::string& body)
{
    return std::all_of(scene.phases.begin(), scene.phases.begin() + static_cast<std::ptrdiff_t>(phase),
                       [&](const scene::Phase& before)
                       { return std::find(before.hold.begin(), before.hold.end(), body) != before.hold.end(); });
}

bool has_motions(const scene::Scene& scene)
{
    return std::any_of(scene.phases.begin(), scene.phases.end(),
                       [](const scene::Phase& phase) { return !phase.motion.empty(); });
}

/// Times and values of all tables: a restart with other tables would go on with another motion.
std::vector<double> tables_of(const scene::Scene& scene)
{
    std::vector<double> all;
    for (const scene::Phase& phase : scene.phases)
    {
        for (const scene::Motion& motion : phase.motion)
        {
            for (const auto& [key, course] : scene::courses_of(motion))
            {
                if (!course.table) { continue; }
                all.insert(all.end(), course.table->time.begin(), course.table->time.end());
                all.insert(all.end(), course.table->value.begin(), course.table->value.end());
            }
        }
    }
    return all;
}

bool is_start(const BodyStart& start)
{
    return start.position.allFinite() && start.velocity.allFinite() && start.angular_velocity.allFinite() &&
           std::abs(start.orientation.norm() - 1) < 1e-6;
}

bool is_force(const ContactForce& force)
{
    return std::isfinite(force.last) && force.impulse.allFinite() && force.mean.allFinite();
}

} // namespace

void ContactForce::note(double time, const Vec3<double>& total)
{
    const double since = time - last;
    if (last >= 0 && since > 0)
    {
        const Vec3<double> now = (total - impulse) / since;
        mean -= std::expm1(-since / CarriedShare::span) * (now - mean);
    }
    last    = time;
    impulse = total;
}

MotionState first_motions(const scene::Scene& scene, const world::World& world)
{
    MotionState state;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    {
        state.mass.push_back(world.bodies.mass[b]);
        state.start.push_back(
            {world.bodies.position[b], world.bodies.orientation[b], world.bodies.velocity[b], Vec3<double>::Zero()});
    }
    state.contact.resize(scene.bodies.size());
    return state;
}

void begin_motions(MotionState& state, const scene::Scene& scene, std::size_t phase,
                   const std::vector<solver::BodyRow>& rows)
{
    for (std::size_t b = 0; b < rows.size(); ++b)
    {
        const solver::BodyRow& row = rows[b];
        state.start[b]             = {row.position, row.orientation, row.velocity, row.angular_velocity};
        if (was_held(scene, phase, scene.bodies[b].name))
        {
            state.start[b].velocity = Vec3<double>(scene.bodies[b].velocity.data());
        }
    }
    state.contact.assign(state.contact.size(), {});
}

Mat3<double> axes_of(scene::MotionFrame frame, const BodyStart& start)
{
    return frame == scene::MotionFrame::world ? Mat3<double>(Mat3<double>::Identity())
                                              : start.orientation.toRotationMatrix();
}

void require_independent_axes(const scene::Scene& scene, const RunningPhase& phase, const MotionState& state,
                              double time)
{
    constexpr double least = 1e-3; ///< volume that the axle and two unit vectors of held axes span
    for (const scene::Motion& motion : keys_of(scene, phase).motion)
    {
        const std::size_t b    = scene::index_of(scene.bodies, motion.body);
        Mat3<double>      axes = axes_of(motion.rotation_frame, state.start[b]);
        axes.col(1)            = state.start[b].orientation * Vec3<double>::UnitY();
        const bool aside       = holds(motion.rotation[0]) && holds(motion.rotation[2]);
        if (!holds(motion.axle) || !aside || std::abs(axes.determinant()) >= least) { continue; }
        throw NumericalError(
            fmt::format("t = {:.6g} s: the axle of '{}' lies in the plane of roll and yaw, which are held "
                        "beside it: rotation_frame = \"body\"",
                        time, motion.body));
    }
}

dem::Prescribed prescribed_in(const scene::Motion& motion, const scene::Body& body, const BodyStart& start, double mass,
                              const Vec3<double>& gravity, const StepOfPhase& step)
{
    dem::Prescribed now        = dem::no_motion();
    now.frame                  = axes_of(motion.frame, start);
    now.turn_frame             = axes_of(motion.rotation_frame, start);
    const Vec3<double> present = now.frame.transpose() * start.velocity,
                       spin    = now.turn_frame.transpose() * start.angular_velocity;
    now.held                   = locked_freedoms(body.lock) |
               hold_axes(motion.translation, dem::lock_x, present, step.end, now.velocity) |
               hold_axes(motion.rotation, dem::lock_roll, spin, step.end, now.spin);
    now.force         = efforts(motion.translation, now.frame, step);
    now.torque        = efforts(motion.rotation, now.turn_frame, step);
    now.axle_torque   = effort(motion.axle, step);
    now.axle_friction = motion.axle_friction;
    if (holds(motion.axle))
    {
        const Vec3<double> axle = start.orientation * Vec3<double>::UnitY();
        now.axle_spin           = held_velocity(motion.axle, start.angular_velocity.dot(axle), step.end);
        now.held |= dem::hold_axle;
    }
    if (motion.load) { now.force += load_force(*motion.load, mass, gravity, step); }
    if (motion.carriage)
    {
        now.stiffness = motion.carriage->stiffness;
        now.damping   = motion.carriage->damping;
        now.height    = motion.carriage->height;
    }
    return now;
}

void add_motions(std::vector<solver::BodyCommand>& commands, const scene::Scene& scene, const RunningPhase& phase,
                 const MotionState& state, double time, double dt)
{
    const Vec3<double> gravity(scene::gravity_in(scene, phase.index).data());
    for (const scene::Motion& motion : keys_of(scene, phase).motion)
    {
        const std::size_t   b = scene::index_of(scene.bodies, motion.body);
        solver::BodyCommand command;
        command.motion =
            prescribed_in(motion, scene.bodies[b], state.start[b], state.mass[b], gravity, {time - phase.start, dt});
        command.locked = dem::prescribed;
        if (is_unyielding(command.motion->held)) { command.locked |= dem::unyielding; }
        commands[b] = command;
    }
}

bool has_stops(const scene::Phase& phase)
{
    return std::any_of(phase.motion.begin(), phase.motion.end(),
                       [](const scene::Motion& motion) { return motion.until.has_value(); });
}

std::optional<std::string> stop_reached(const scene::Motion& motion, const Mat3<double>& frame,
                                        const Vec3<double>& moved, const Vec3<double>& force)
{
    if (!motion.until) { return {}; }
    const Vec3<double> way = frame.transpose() * moved, load = frame.transpose() * force;
    for (int c = 0; c < 3; ++c)
    {
        const auto  axis = static_cast<std::size_t>(c);
        const char* name = scene::translation_axes[axis];
        if (motion.until->force[axis] && std::abs(load[c]) >= *motion.until->force[axis])
        {
            return fmt::format("force_{} = {:.4g} N", name, std::abs(load[c]));
        }
        if (motion.until->displacement[axis] && std::abs(way[c]) >= *motion.until->displacement[axis])
        {
            return fmt::format("displacement_{} = {:.4g} m", name, std::abs(way[c]));
        }
    }
    return {};
}

void turn_reactions(std::vector<solver::BodyRow>& rows, const scene::Scene& scene, const RunningPhase& phase,
                    const MotionState& state)
{
    const Vec3<double>  none = Vec3<double>::Constant(std::numeric_limits<double>::quiet_NaN());
    const scene::Phase& keys = scene.phases[std::min(phase.index, scene.phases.size() - 1)]; // the last row follows it
    for (std::size_t b = 0; b < rows.size(); ++b)
    {
        const scene::Motion* motion = scene::motion_of(keys, scene.bodies[b].name);
        solver::BodyRow&     row    = rows[b];
        if (motion == nullptr)
        {
            row.reaction_force = row.reaction_torque = none;
            continue;
        }
        row.reaction_force  = axes_of(motion->frame, state.start[b]).transpose() * row.reaction_force;
        row.reaction_torque = axes_of(motion->rotation_frame, state.start[b]).transpose() * row.reaction_torque;
    }
}

void transfer(solver::StateFile& file, const scene::Scene& scene, MotionState& state)
{
    if (!has_motions(scene)) { return; }
    namespace accept           = solver::accept;
    const std::size_t   named  = scene.bodies.size();
    std::vector<double> tables = tables_of(scene);
    file.common("phases/tables", tables, accept::same_as(tables_of(scene)));
    file.common("phases/body_starts", state.start,
                accept::all(accept::rows(named), accept::each("the start of a body in its phase", is_start)));
    file.common("phases/contact_forces", state.contact,
                accept::all(accept::rows(named), accept::each("the contact force on a body", is_force)));
}

} // namespace tread::run
