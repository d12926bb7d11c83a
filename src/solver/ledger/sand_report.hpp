#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "kernels/mpm/grid/grid.hpp"
#include "kernels/mpm/pages/census.hpp"
#include "kernels/mpm/transfers/gather.hpp"

namespace tread::solver
{

class StateFile;

/// A report as read back: sums of the grid, sums of the points, peaks of the points.
inline constexpr int report_sums = mpm::tally_width(mpm::grid_sums) + mpm::tally_width(mpm::point_sums);
using ReportTotals               = std::array<double, report_sums + mpm::point_peaks>;

/// Mass, energy and momentum of the sand.
struct SandCensus
{
    double       mass     = 0;                    ///< kg
    double       kinetic  = 0;                    ///< J
    double       strain   = 0;                    ///< J
    Vec3<double> momentum = Vec3<double>::Zero(); ///< kg m/s
    Vec3<double> moment   = Vec3<double>::Zero(); ///< kg m, mass times position
};

inline SandCensus operator+(const SandCensus& a, const SandCensus& b)
{
    return {a.mass + b.mass, a.kinetic + b.kinetic, a.strain + b.strain, a.momentum + b.momentum, a.moment + b.moment};
}

inline SandCensus operator-(const SandCensus& a, const SandCensus& b)
{
    return {a.mass - b.mass, a.kinetic - b.kinetic, a.strain - b.strain, a.momentum - b.momentum, a.moment - b.moment};
}

/// Converts totals indexed by mpm::PointCensus.
inline SandCensus census_of(const double* total)
{
    return {total[mpm::census_mass], total[mpm::census_kinetic], total[mpm::census_strain],
            Vec3<double>(total + mpm::census_momentum), Vec3<double>(total + mpm::census_moment)};
}

/// Saves a census to the data sets `name`_mass, `name`_kinetic and so on of a checkpoint, or loads it.
void transfer(StateFile& file, const std::string& name, SandCensus& census);

/// Report of the steps since the last one.
struct SandReport
{
    std::int64_t steps                        = 0;
    double       grid[mpm::grid_sums]         = {}; ///< by mpm::GridSum, over all these steps
    double       last_grid[mpm::grid_sums]    = {}; ///< sums of the last step
    double       points[mpm::point_sums]      = {}; ///< by mpm::PointSum
    double       last_points[mpm::point_sums] = {};
    double       peaks[mpm::point_peaks]      = {}; ///< by mpm::PointPeak
    double       largest_speed                = 0;  ///< m/s, largest of a point

    mpm::CellChange cell_change() const
    {
        return static_cast<mpm::CellChange>(static_cast<int>(peaks[mpm::peak_cell_change]));
    }

    /// W, power of weight and stress at the points' velocity after the last step.
    double power() const;

    /// J, part of the stored `half_step` that the transfer dissipates: what half a step of that power loses between
    /// each step's end and the next P2G, where velocities are those of the grid. `dt`: s, of these steps; `held`: J,
    /// half a step of power() before them, with the step length of that time.
    double half_step_transfer(double dt, double held) const;
};

} // namespace tread::solver
