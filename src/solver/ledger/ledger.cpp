#include "solver/ledger/ledger.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

/// A mode of frequency w stores at most w dt / 2 of its energy in half a step's power; at 1 it is unstable.
constexpr double unresolved_share = 0.75;

double mass(const Census& census) { return census.sand.mass + census.rigid.mass; }

Vec3<double> momentum(const Census& census) { return census.sand.momentum + census.rigid.momentum; }

} // namespace

Ledger::Ledger(Vec3<double> gravity, const Census& start)
    : gravity_(std::move(gravity))
    , largest_gravity_(gravity_.norm())
    , start_(start)
    , kinetic_points_(start.sand.kinetic)
{
    start_energy_  = stored(start);
    start_gravity_ = gravity_energy(start);
}

void Ledger::turn_gravity(const Vec3<double>& gravity, const Census& before, const Census& after)
{
    const double energy = gravity_energy(before);
    gravity_            = gravity;
    largest_gravity_    = std::max(largest_gravity_, gravity_.norm());
    turned_ += gravity_energy(after) - energy;
}

void Ledger::release(double bodies, double sand)
{
    friction_ += bodies + sand;
    contact_energy_ -= sand;
}

double Ledger::stored(const Census& now) const
{
    return now.sand.kinetic + half_step_ + body_half_step_ + now.sand.strain + now.rigid.kinetic + now.rigid.contact +
           now.sand_contact + gravity_energy(now);
}

double Ledger::gravity_energy(const Census& now) const
{
    return now.rigid.gravity - gravity_.dot(now.sand.moment) - turned_;
}

void Ledger::steps(double dt, std::int64_t steps, const SandReport& sand, const RigidReport& rigid,
                   const ContactReport& contact, double moving_mass)
{
    const double span = dt * static_cast<double>(steps);
    time_ += span;
    // Transfer loss per step: energy of the points before it minus that of the grid, plus that of the grid after it
    // minus that of the points. Over a span the points' energies telescope to first minus last; write the sum.
    const double kinetic = sand.last_points[mpm::point_kinetic];
    transfer_ += kinetic_points_ - kinetic + sand.grid[mpm::grid_kinetic_after] - sand.grid[mpm::grid_kinetic_before] +
                 sand.half_step_transfer(dt, half_step_);
    half_step_        = 0.5 * dt * sand.power();
    stress_half_step_ = -0.5 * dt * sand.last_points[mpm::point_stress_power];
    kinetic_points_   = kinetic;
    transfer_ += body_half_step_ - 0.5 * rigid.substep * std::exchange(weight_power_, rigid.weight_power);
    body_half_step_ = 0.5 * rigid.substep * rigid.weight_power;
    plastic_ += sand.points[mpm::point_plastic_work];
    damping_ += sand.grid[mpm::grid_damped] + rigid.damped;
    friction_ += contact.friction + rigid.friction + sand.grid[mpm::grid_friction] + sand.grid[mpm::grid_wall_loss];
    coupling_ -= rigid.sand_work + sand.points[mpm::point_contact_work] + contact.friction + contact.energy -
                 std::exchange(contact_energy_, contact.energy);
    restitution_ += rigid.restitution;
    work_in_ += rigid.driver_work;
    mass_scaling_ += rigid.scaling_work;
    impulse_ += moving_mass * span * gravity_ + Vec3<double>(sand.grid + mpm::grid_wall_impulse) +
                Vec3<double>(sand.grid + mpm::grid_damping_impulse) + rigid.wall_impulse + rigid.damping_impulse +
                rigid.driver_impulse;
}

double Ledger::gained(const Census& now) const
{
    const bool stable = std::abs(stress_half_step_) <= unresolved_share * (now.sand.kinetic + now.sand.strain);
    return (stable ? 0 : half_step_) + std::min(coupling_, 0.0);
}

EnergyRow Ledger::energy(const Census& now)
{
    EnergyRow row;
    row.kinetic_points = now.sand.kinetic;
    row.strain         = now.sand.strain;
    row.kinetic_bodies = now.rigid.kinetic;
    row.contact        = now.rigid.contact + now.sand_contact;
    row.gravity        = gravity_energy(now);
    row.half_step      = half_step_ + body_half_step_;
    row.plastic        = plastic_;
    row.friction       = friction_;
    row.restitution    = restitution_;
    row.damping        = damping_;
    row.transfer       = transfer_;
    row.coupling       = coupling_;
    row.mass_scaling   = mass_scaling_;
    row.work_in        = work_in_;
    row.total =
        stored(now) + plastic_ + friction_ + restitution_ + damping_ + transfer_ + coupling_ + mass_scaling_ - work_in_;

    const double fallen = start_gravity_ - row.gravity;
    for (const double exchange :
         {row.kinetic_points, row.kinetic_bodies, fallen, plastic_, friction_, damping_, work_in_, row.strain})
    {
        largest_exchange_ = std::max(largest_exchange_, std::abs(exchange));
    }
    if (largest_exchange_ > 0)
    {
        errors_.energy   = (row.total - start_energy_ - gained(now)) / largest_exchange_;
        errors_.transfer = transfer_ / largest_exchange_;
        errors_.coupling = coupling_ / largest_exchange_;

        errors_.mass_scaling = mass_scaling_ / largest_exchange_;
    }
    return row;
}

BalanceRow Ledger::balance(const Census& now)
{
    BalanceRow row;
    row.mass            = mass(now);
    row.momentum        = momentum(now);
    const double weight = mass(start_) * largest_gravity_;
    if (time_ > 0 && weight > 0)
    {
        row.impulse_error = (row.momentum - momentum(start_) - impulse_).norm() / (weight * time_);
        errors_.momentum  = std::max(errors_.momentum, row.impulse_error);
    }
    errors_.mass = std::max(errors_.mass, std::abs(row.mass - mass(start_)) / mass(start_));
    return row;
}

void Ledger::transfer(StateFile& file)
{
    transfer_start(file);
    transfer_sums(file);
    file.numbers("ledger/largest_exchange", accept::number(largest_exchange_, 0, accept::largest));
    file.numbers("ledger/error_mass", accept::number(errors_.mass, 0, accept::largest));
    file.numbers("ledger/error_momentum", accept::number(errors_.momentum, 0, accept::largest));
    file.numbers("ledger/error_energy", errors_.energy);
    file.numbers("ledger/error_transfer", errors_.transfer);
    file.numbers("ledger/error_coupling", errors_.coupling);
    file.numbers("ledger/error_mass_scaling", errors_.mass_scaling);
}

void Ledger::transfer_start(StateFile& file)
{
    solver::transfer(file, "ledger/start_sand", start_.sand);
    file.numbers("ledger/start_bodies_mass", accept::number(start_.rigid.mass, 0, accept::largest));
    file.numbers("ledger/start_bodies_kinetic", start_.rigid.kinetic);
    file.numbers("ledger/start_bodies_contact", start_.rigid.contact);
    file.numbers("ledger/start_bodies_gravity", start_.rigid.gravity);
    file.doubles("ledger/start_bodies_momentum", start_.rigid.momentum);
    file.numbers("ledger/start_sand_contact", start_.sand_contact);
    file.numbers("ledger/start_energy", start_energy_);
}

void Ledger::transfer_sums(StateFile& file)
{
    file.numbers("ledger/time", accept::number(time_, 0, accept::largest));
    file.numbers("ledger/kinetic_points", kinetic_points_);
    file.numbers("ledger/half_step", half_step_);
    file.numbers("ledger/stress_half_step", stress_half_step_);
    file.numbers("ledger/body_half_step", body_half_step_);
    file.numbers("ledger/plastic", plastic_);
    file.numbers("ledger/friction", friction_);
    file.numbers("ledger/restitution", restitution_);
    file.numbers("ledger/damping", damping_);
    file.numbers("ledger/transfer", transfer_);
    file.numbers("ledger/work_in", work_in_);
    file.numbers("ledger/coupling", coupling_);
    file.numbers("ledger/mass_scaling", mass_scaling_);
    file.numbers("ledger/contact_energy", contact_energy_);
    file.numbers("ledger/weight_power", weight_power_);
    file.doubles("ledger/impulse", impulse_);
    file.doubles("ledger/gravity", gravity_);
    file.numbers("ledger/turned", turned_);
    file.numbers("ledger/start_gravity", start_gravity_);
    file.numbers("ledger/largest_gravity", accept::number(largest_gravity_, 0, accept::largest));
}

} // namespace tread::solver
