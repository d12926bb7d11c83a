#include "solver/bodies/body_commands.hpp"

#include <algorithm>
#include <cmath>

#include "backend/instantiate.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

/// Bits of BodiesView::locked. The weight of a body that is locked in all directions does no work.
std::uint32_t flags_of(const BodyCommand& command)
{
    const bool hangs = command.weight != 1 && command.locked != dem::lock_all;
    return command.locked | (hangs ? static_cast<std::uint32_t>(dem::hangs) : 0u);
}

/// Motion of a named body, which a command may change.
struct CommandedMotion
{
    Vec3<double>  velocity; ///< m/s
    Vec3<double>  spin;     ///< rad/s
    std::uint32_t flags;    ///< bits of BodiesView::locked

    bool operator==(const CommandedMotion&) const = default;
};

/// Velocity under the present command of a body that had `velocity`; `before` is the last command.
Vec3<double> commanded_velocity(BodyCommands& commands, std::size_t body, const std::optional<BodyCommand>& before,
                                Vec3<double> velocity, const world::World& world)
{
    const BodyCommand& command = *commands.present[body];
    if (command.lowering)
    {
        commands.released[body] = true; // lowered onto the ground, then released at rest
        return Vec3<double>(command.lowering->data());
    }
    if (before && before->lowering) { velocity.setZero(); }
    if (command.locked == dem::lock_all) { velocity.setZero(); }
    else if (!commands.released[body])
    {
        velocity                = world.bodies.velocity[body];
        commands.released[body] = true;
    }
    for (int c = 0; c < 3; ++c)
    {
        if ((command.locked & (static_cast<unsigned>(dem::lock_x) << c)) != 0) { velocity[c] = 0; }
    }
    if (command.forward) { velocity[0] = *command.forward; }
    return velocity;
}

/// Spin under a command of a body that had `spin`; `rotation`: body to world.
Vec3<double> commanded_spin(const BodyCommand& command, Vec3<double> spin, const Mat3<double>& rotation)
{
    for (int c = 0; c < 3; ++c)
    {
        if ((command.locked & (static_cast<unsigned>(dem::lock_roll) << c)) != 0) { spin[c] = 0; }
    }
    if (command.spin) { spin = *command.spin * (rotation * Vec3<double>::UnitY()); }
    return spin;
}

/// Accounts for the work and the impulse of a change of motion. `inertia`: kg m2, in the world frame.
void account(CommandTotals& totals, const CommandedMotion& before, const CommandedMotion& after, double mass,
             const Mat3<double>& inertia)
{
    totals.impulse += mass * (after.velocity - before.velocity);
    totals.work += 0.5 * mass * (after.velocity.squaredNorm() - before.velocity.squaredNorm()) +
                   0.5 * (after.spin.dot(inertia * after.spin) - before.spin.dot(inertia * before.spin));
}

/// Applies the present command of a body; returns whether that changes its motion.
template<class Exec>
bool set_motion(BodyState<Exec>& state, BodyCommands& commands, std::size_t b, const std::optional<BodyCommand>& last)
{
    const BodyCommand&    command  = *commands.present[b];
    const world::World&   world    = state.world;
    const dem::BodiesView bodies   = state.view();
    const CommandedMotion before   = {read(state.exec, bodies.velocity + b),
                                      read(state.exec, bodies.angular_velocity + b), read(state.exec, bodies.locked + b)};
    const Mat3<double>    rotation = read(state.exec, bodies.orientation + b).toRotationMatrix();
    const CommandedMotion after    = {commanded_velocity(commands, b, last, before.velocity, world),
                                      commanded_spin(command, before.spin, rotation), flags_of(command)};
    if (after == before) { return false; }

    const Mat3<double> inertia = rotation * full(read(state.exec, bodies.inertia + b)) * rotation.transpose();
    if (state.owns(static_cast<std::int64_t>(b)))
    {
        account(commands.totals, before, after, world.bodies.mass[b], inertia);
    }
    const auto&  form      = world.templates[static_cast<std::size_t>(world.bodies.shape[b])];
    const double rim_speed = after.spin.norm() * world.bodies.scale[b] * form.bounding_radius;
    commands.largest_speed = std::max(commands.largest_speed, after.velocity.norm() + rim_speed);
    copy_from_host(state.exec, bodies.velocity + b, &after.velocity, sizeof(after.velocity));
    copy_from_host(state.exec, bodies.angular_velocity + b, &after.spin, sizeof(after.spin));
    copy_from_host(state.exec, bodies.locked + b, &after.flags, sizeof(after.flags));
    return true;
}

/// Last command of a named body, as doubles.
struct CommandRow
{
    double given, locked, has_spin, spin, has_forward, forward, has_lowering, lowering[3], weight;
};

CommandRow row_of(const std::optional<BodyCommand>& command)
{
    if (!command) { return {}; }
    const auto lowering = command->lowering.value_or(std::array<double, 3>{});
    return {1.0,
            static_cast<double>(command->locked),
            command->spin ? 1.0 : 0.0,
            command->spin.value_or(0),
            command->forward ? 1.0 : 0.0,
            command->forward.value_or(0),
            command->lowering ? 1.0 : 0.0,
            {lowering[0], lowering[1], lowering[2]},
            command->weight};
}

std::optional<BodyCommand> command_of(const CommandRow& row)
{
    if (row.given == 0) { return {}; }
    BodyCommand command{static_cast<std::uint32_t>(row.locked), {}, {}};
    command.weight = row.weight;
    if (row.has_spin != 0) { command.spin = row.spin; }
    if (row.has_forward != 0) { command.forward = row.forward; }
    if (row.has_lowering != 0) { command.lowering = {row.lowering[0], row.lowering[1], row.lowering[2]}; }
    return command;
}

/// Accepts commands that a named body can have received.
auto commands_that_can_be()
{
    constexpr double freedoms = dem::all_flags;
    const auto       flag     = [](double value) { return value == 0 || value == 1; };
    return accept::all(accept::finite(), accept::each("a command of a body",
                                                      [flag](const CommandRow& row)
                                                      {
                                                          return flag(row.given) && flag(row.has_spin) &&
                                                                 flag(row.has_forward) && flag(row.has_lowering) &&
                                                                 row.locked >= 0 && row.locked <= freedoms &&
                                                                 row.locked == std::floor(row.locked);
                                                      }));
}

} // namespace

void BodyCommands::transfer(StateFile& file)
{
    file.doubles("bodies/command_impulse", totals.impulse);
    std::vector<CommandRow>   rows;
    std::vector<std::int32_t> free_before(released.begin(), released.end());
    for (const auto& command : present) { rows.push_back(row_of(command)); }
    const std::size_t named = present.size();
    file.common("bodies/commanded", rows, accept::all(accept::rows(named), commands_that_can_be()));
    file.common("bodies/released", free_before, accept::all(accept::rows(named), accept::within(0, 1)));
    if (!file.loads()) { return; }
    std::transform(rows.begin(), rows.end(), present.begin(), command_of);
    std::transform(free_before.begin(), free_before.end(), released.begin(),
                   [](std::int32_t value) { return value != 0; });
}

template<class Exec>
bool apply_commands(BodyState<Exec>& state, BodyCommands& commands, const std::vector<BodyCommand>& wanted)
{
    bool changed      = false;
    commands.heaviest = 1;
    for (std::size_t b = 0; b < wanted.size(); ++b)
    {
        commands.heaviest = std::max(commands.heaviest, wanted[b].weight);
        if (commands.present[b] == wanted[b]) { continue; } // locked components have kept their velocity
        const std::optional<BodyCommand> last = std::exchange(commands.present[b], wanted[b]);
        copy_from_host(state.exec, state.bodies.weight.data() + b, &wanted[b].weight, sizeof(double));
        changed = set_motion(state, commands, b, last) || changed;
    }
    return changed;
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template bool apply_commands(BodyState<Exec>&, BodyCommands&, const std::vector<BodyCommand>&)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
