#include <algorithm>

#include "backend/instantiate.hpp"
#include "solver/dem_solver.hpp"

// Commands of named bodies: held, lowered, driven or free, and the share of their weight that acts.
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

} // namespace

template<class Exec>
void DemSolver<Exec>::command(const std::vector<BodyCommand>& commands)
{
    bool changed = false;
    heaviest_    = 1;
    for (std::size_t b = 0; b < commands.size(); ++b)
    {
        heaviest_ = std::max(heaviest_, commands[b].weight);
        if (commanded_[b] == commands[b]) { continue; } // locked components have kept their velocity
        const std::optional<BodyCommand> before = std::exchange(commanded_[b], commands[b]);
        copy_from_host(exec_, bodies_.weight.data() + b, &commands[b].weight, sizeof(double));
        changed = set_motion(b, before) || changed;
    }
    if (changed && listed_) { stage(); }
}

/// Velocity under the present command of a body that had `velocity`; `before` is the last command.
template<class Exec>
Vec3<double> DemSolver<Exec>::commanded_velocity(std::size_t body, const std::optional<BodyCommand>& before,
                                                 Vec3<double> velocity)
{
    const BodyCommand& command = *commanded_[body];
    if (command.lowering)
    {
        released_[body] = true; // lowered onto the ground, then released at rest
        return Vec3<double>(command.lowering->data());
    }
    if (before && before->lowering) { velocity.setZero(); }
    if (command.locked == dem::lock_all) { velocity.setZero(); }
    else if (!released_[body])
    {
        velocity        = world_.bodies.velocity[body];
        released_[body] = true;
    }
    for (int c = 0; c < 3; ++c)
    {
        if ((command.locked & (static_cast<unsigned>(dem::lock_x) << c)) != 0) { velocity[c] = 0; }
    }
    if (command.forward) { velocity[0] = *command.forward; }
    return velocity;
}

/// Applies the present command; returns whether that changes the motion. Accounts for the work and impulse.
template<class Exec>
bool DemSolver<Exec>::set_motion(std::size_t b, const std::optional<BodyCommand>& before)
{
    const BodyCommand&  command         = *commanded_[b];
    const std::uint32_t flags           = flags_of(command);
    const Vec3<double>  velocity_before = read(exec_, bodies_.velocity.data() + b);
    const Vec3<double>  spin_before     = read(exec_, bodies_.angular_velocity.data() + b);
    const std::uint32_t flags_before    = read(exec_, bodies_.locked.data() + b);
    const Mat3<double>  rotation        = read(exec_, bodies_.orientation.data() + b).toRotationMatrix();
    const Vec3<double>  velocity        = commanded_velocity(b, before, velocity_before);
    Vec3<double>        spin            = spin_before;
    for (int c = 0; c < 3; ++c)
    {
        if ((command.locked & (static_cast<unsigned>(dem::lock_roll) << c)) != 0) { spin[c] = 0; }
    }
    if (command.spin) { spin = *command.spin * (rotation * Vec3<double>::UnitY()); }
    if (velocity == velocity_before && spin == spin_before && flags_before == flags) { return false; }

    const Mat3<double> inertia = rotation * full(read(exec_, bodies_.inertia.data() + b)) * rotation.transpose();
    const double       mass    = world_.bodies.mass[b];
    if (!ranks_ || ranks_->owns(static_cast<std::int64_t>(b)))
    {
        command_impulse_ += mass * (velocity - velocity_before);
        command_work_ += 0.5 * mass * (velocity.squaredNorm() - velocity_before.squaredNorm()) +
                         0.5 * (spin.dot(inertia * spin) - spin_before.dot(inertia * spin_before));
    }
    const auto& form = world_.templates[static_cast<std::size_t>(world_.bodies.shape[b])];
    commanded_speed_ =
        std::max(commanded_speed_, velocity.norm() + spin.norm() * world_.bodies.scale[b] * form.bounding_radius);
    copy_from_host(exec_, bodies_.velocity.data() + b, &velocity, sizeof(velocity));
    copy_from_host(exec_, bodies_.angular_velocity.data() + b, &spin, sizeof(spin));
    copy_from_host(exec_, bodies_.locked.data() + b, &flags, sizeof(flags));
    return true;
}

#define TREAD_INSTANTIATE(Exec) template void DemSolver<Exec>::command(const std::vector<BodyCommand>&)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
