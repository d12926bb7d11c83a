#include "solver/sand_report.hpp"

namespace tread::solver
{
namespace
{

double power_of(const double* grid, const double* points)
{
    return grid[mpm::grid_gravity_power] - points[mpm::point_stress_power];
}

} // namespace

double SandReport::power() const { return power_of(last_grid, last_points); }

double SandReport::half_step_transfer(double dt, double held) const
{
    const double between = power_of(grid, points) - power(); // of all steps but the last
    return held + 0.5 * dt * (between - grid[mpm::grid_power_before] + points[mpm::point_contact_power]);
}

} // namespace tread::solver
