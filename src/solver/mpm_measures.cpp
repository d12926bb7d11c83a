#include <algorithm>
#include <cmath>
#include <utility>

#include "backend/instantiate.hpp"
#include "decomp/combine.hpp"
#include "solver/mpm_solver.hpp"

// Measurements of the sand: sums and peaks over the steps, and the census.
namespace tread::solver
{
namespace
{

/// Copies `count` values; returns the position after them.
const double* take(const double* from, int count, double* to)
{
    std::copy(from, from + count, to);
    return from + count;
}

} // namespace

template<class Exec, class Real>
SandReport MpmSolver<Exec, Real>::report()
{
    if (!requested_) { request_report(); }
    requested_ = false;
    synchronize(exec_);
    ReportTotals told = readback_.get();
    if (ranks_) { decomp::combine(ranks_->communicator(), told.data(), report_sums, mpm::point_peaks); }
    SandReport    report;
    const double* from = told.data();
    for (double* to : {report.grid, report.last_grid}) { from = take(from, mpm::grid_sums, to); }
    for (double* to : {report.points, report.last_points}) { from = take(from, mpm::point_sums, to); }
    take(from, mpm::point_peaks, report.peaks);
    report.last_points[mpm::point_kinetic] += left_[mpm::census_kinetic];
    report.last_points[mpm::point_strain] += left_[mpm::census_strain];
    report.largest_speed = std::sqrt(report.peaks[mpm::peak_speed_squared]);
    report.steps         = std::exchange(steps_, 0);
    cell_change_         = report.cell_change();
    if (sleep_)
    {
        report.last_points[mpm::point_strain] += sleep_->census().strain;
        const Vec3<double> stopped = sleep_->take_impulse();
        for (int c = 0; c < 3; ++c) { report.grid[mpm::grid_wall_impulse + c] += stopped[c]; }
    }
    return report;
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::request_report()
{
    const std::int64_t point_pages = pages_.point_page_key.size(), node_pages = pages_.node_page_key.size();
    constexpr int      grid_width = mpm::tally_width(mpm::grid_sums), point_width = mpm::tally_width(mpm::point_sums);
    double*            grid   = totals_.data();
    double*            points = grid + grid_width;
    double*            peaks  = points + point_width;
    if (ranks_) { ranks_->halo().clear_booked_elsewhere(grid_width, grid_rows_.data()); }
    sum_rows(exec_, grid_rows_.data(), node_pages, grid_width, grid, sums_scratch_);
    sum_rows(exec_, point_rows_.data(), point_pages, point_width, points, sums_scratch_);
    largest_of_rows(exec_, peak_rows_.data(), point_pages, mpm::point_peaks, peaks);
    readback_.request(reinterpret_cast<const ReportTotals*>(grid));
    if (sleep_) { sleep_->note(peak_rows_.data()); }
    clear_tallies();
    requested_ = true;
}

template<class Exec, class Real>
SandCensus MpmSolver<Exec, Real>::census()
{
    order();
    const std::int64_t point_pages = pages_.point_page_key.size();
    census_rows_.resize(point_pages * mpm::census_count);
    mpm::take_census(exec_, points_.view(), pages(), materials_.data(), census_rows_.data());
    sum_rows(exec_, census_rows_.data(), point_pages, mpm::census_count, totals_.data());
    double total[mpm::census_count];
    copy_to_host(exec_, total, totals_.data(), sizeof(total));
    if (ranks_) { decomp::combine(ranks_->communicator(), total, mpm::census_count, 0); }
    SandCensus census = census_of(total);
    if (sleep_) { census = census + sleep_->census(); }
    mass_ = census.mass;
    return census + census_of(left_.data());
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template SandReport MpmSolver<Exec, Real>::report();                                                               \
    template void       MpmSolver<Exec, Real>::request_report();                                                       \
    template SandCensus MpmSolver<Exec, Real>::census()
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
