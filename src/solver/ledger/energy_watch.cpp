#include "solver/ledger/energy_watch.hpp"

#include <algorithm>
#include <cmath>

#include "solver/state_file.hpp"

namespace tread::solver
{

EnergyWatch::EnergyWatch(double mass, double wave_speed)
    : floor_(0.5e-20 * mass * wave_speed * wave_speed)
    , held_(floor_)
{
}

void EnergyWatch::add(const SandReport& sand, double dt)
{
    const double strain    = sand.last_points[mpm::point_strain];
    const bool   started   = strain_ >= 0;
    const double stored    = started ? strain - strain_ : 0;
    strain_                = strain;
    const double half_step = sand.half_step_transfer(dt, half_step_);
    half_step_             = 0.5 * dt * sand.power();
    if (!started) { return; }

    const double gravity = sand.grid[mpm::grid_gravity_work], contact = sand.points[mpm::point_contact_work];
    const double stress_work = sand.grid[mpm::grid_kinetic_after] - sand.grid[mpm::grid_kinetic_before] +
                               sand.grid[mpm::grid_damped] + sand.grid[mpm::grid_wall_loss] +
                               sand.grid[mpm::grid_friction] - gravity - contact;
    const double kept = std::pow(1 - 1 / memory, static_cast<double>(sand.steps));
    appeared_         = kept * appeared_ + stress_work + stored + sand.points[mpm::point_plastic_work];
    transferred_      = kept * transferred_ + half_step;
    received_         = kept * received_ + std::abs(gravity) + std::abs(contact);
    held_             = std::max({kept * held_, strain + sand.last_points[mpm::point_kinetic], floor_});
}

void EnergyWatch::transfer(StateFile& file)
{
    file.numbers("energy_watch/floor", accept::number(floor_, 0, accept::largest));
    file.numbers("energy_watch/strain", strain_);
    file.numbers("energy_watch/half_step", half_step_);
    file.numbers("energy_watch/appeared", appeared_);
    file.numbers("energy_watch/transferred", transferred_);
    file.numbers("energy_watch/held", accept::number(held_, 0, accept::largest));
    file.numbers("energy_watch/received", accept::number(received_, 0, accept::largest));
}

} // namespace tread::solver
