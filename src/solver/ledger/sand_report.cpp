#include "solver/ledger/sand_report.hpp"

#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

double power_of(const double* grid, const double* points)
{
    return grid[mpm::grid_gravity_power] - points[mpm::point_stress_power];
}

} // namespace

void transfer(StateFile& file, const std::string& name, SandCensus& census)
{
    file.numbers(name + "_mass", census.mass);
    file.numbers(name + "_kinetic", census.kinetic);
    file.numbers(name + "_strain", census.strain);
    file.doubles(name + "_momentum", census.momentum);
    file.doubles(name + "_moment", census.moment);
}

double SandReport::power() const { return power_of(last_grid, last_points); }

double SandReport::half_step_transfer(double dt, double held) const
{
    const double between = power_of(grid, points) - power(); // of all steps but the last
    return held + 0.5 * dt * (between - grid[mpm::grid_power_before] + points[mpm::point_contact_power]);
}

} // namespace tread::solver
