#include "solver/sand/sand_tallies.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "backend/instantiate.hpp"
#include "backend/reduce.hpp"
#include "decomp/combine.hpp"

namespace tread::solver
{
namespace
{

/// Size for a census, or for a report.
constexpr std::int64_t totals_size = std::int64_t{mpm::census_count} + std::int64_t{std::tuple_size_v<ReportTotals>};

constexpr int grid_width = mpm::tally_width(mpm::grid_sums), point_width = mpm::tally_width(mpm::point_sums);

/// Copies `count` values; returns the position after them.
const double* take(const double* from, int count, double* to)
{
    std::copy(from, from + count, to);
    return from + count;
}

} // namespace

template<class Exec>
SandTallies<Exec>::SandTallies(const Exec& exec)
    : grid_rows(exec, "grid sums")
    , point_rows(exec, "point sums")
    , peak_rows(exec, "point peaks")
    , census_rows(exec, "point census")
    , totals(exec, "sand totals", totals_size)
    , sums_scratch(exec, "sand sums scratch")
    , readback(exec, "sand sums on the host")
{
}

template<class Exec>
void resize_tallies(SandTallies<Exec>& tallies, const mpm::Pages<Exec>& pages)
{
    const std::int64_t point_pages = pages.point_page_key.size(), node_pages = pages.node_page_key.size();
    tallies.grid_rows.resize(node_pages * grid_width);
    tallies.point_rows.resize(point_pages * point_width);
    tallies.peak_rows.resize(point_pages * mpm::point_peaks);
    clear_tallies(tallies);
}

template<class Exec>
void clear_tallies(SandTallies<Exec>& tallies)
{
    tallies.grid_rows.fill_zero();
    tallies.point_rows.fill_zero();
    tallies.peak_rows.fill_zero();
}

template<class Exec>
void request_totals(const Exec& exec, SandTallies<Exec>& tallies, const mpm::Pages<Exec>& pages)
{
    const std::int64_t point_pages = pages.point_page_key.size(), node_pages = pages.node_page_key.size();
    double*            grid   = tallies.totals.data();
    double*            points = grid + grid_width;
    double*            peaks  = points + point_width;
    sum_rows(exec, tallies.grid_rows.data(), node_pages, grid_width, grid, tallies.sums_scratch);
    sum_rows(exec, tallies.point_rows.data(), point_pages, point_width, points, tallies.sums_scratch);
    largest_of_rows(exec, tallies.peak_rows.data(), point_pages, mpm::point_peaks, peaks);
    tallies.readback.request(reinterpret_cast<const ReportTotals*>(grid));
    tallies.requested = true;
}

template<class Exec>
SandReport take_report(const Exec& exec, SandTallies<Exec>& tallies, const Communicator* communicator)
{
    tallies.requested = false;
    synchronize(exec);
    ReportTotals totals = tallies.readback.get();
    if (communicator != nullptr) { decomp::combine(*communicator, totals.data(), report_sums, mpm::point_peaks); }
    SandReport    report;
    const double* from = totals.data();
    for (double* to : {report.grid, report.last_grid}) { from = take(from, mpm::grid_sums, to); }
    for (double* to : {report.points, report.last_points}) { from = take(from, mpm::point_sums, to); }
    take(from, mpm::point_peaks, report.peaks);
    report.last_points[mpm::point_kinetic] += tallies.left[mpm::census_kinetic];
    report.last_points[mpm::point_strain] += tallies.left[mpm::census_strain];
    report.largest_speed = std::sqrt(report.peaks[mpm::peak_speed_squared]);
    report.steps         = std::exchange(tallies.steps, 0);
    return report;
}

template<class Exec, class Real>
SandCensus take_census(const Exec& exec, SandTallies<Exec>& tallies, const mpm::PointsView<Real>& points,
                       const mpm::PagesView& pages, const mpm::MaterialParameters<Real>* materials,
                       const Communicator* communicator)
{
    tallies.census_rows.resize(pages.point_pages * mpm::census_count);
    mpm::take_census(exec, points, pages, materials, tallies.census_rows.data());
    sum_rows(exec, tallies.census_rows.data(), pages.point_pages, mpm::census_count, tallies.totals.data());
    double total[mpm::census_count];
    copy_to_host(exec, total, tallies.totals.data(), sizeof(total));
    if (communicator != nullptr) { decomp::combine(*communicator, total, mpm::census_count, 0); }
    return census_of(total);
}

/// A census counts these points as one page.
template<class Exec, class Real>
void account_for_left(const Exec& exec, SandTallies<Exec>& tallies, mpm::Points<Exec, Real>& points, std::int64_t count,
                      mpm::PagesView pages, const mpm::MaterialParameters<Real>* materials,
                      const Communicator* communicator)
{
    double row[mpm::census_count] = {};
    if (count > 0)
    {
        std::vector<std::int32_t> places(static_cast<std::size_t>(count));
        std::iota(places.begin(), places.end(), static_cast<std::int32_t>(points.count));
        Array<Exec, std::int32_t> place(exec, "points that left"), range(exec, "range of points that left");
        place.assign(places);
        range.assign({0, static_cast<std::int32_t>(count)});
        pages.point_pages = 1;
        pages.first_point = range.data();
        pages.point_at    = place.data();
        tallies.census_rows.resize(mpm::census_count);
        mpm::take_census(exec, points.view(), pages, materials, tallies.census_rows.data());
        copy_to_host(exec, row, tallies.census_rows.data(), sizeof(row));
    }
    if (communicator != nullptr) { decomp::combine(*communicator, row, mpm::census_count, 0); }
    for (std::size_t c = 0; c < tallies.left.size(); ++c) { tallies.left[c] += row[c]; }
    tallies.mass -= row[mpm::census_mass];
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template struct SandTallies<Exec>;                                                                                 \
    template void       resize_tallies(SandTallies<Exec>&, const mpm::Pages<Exec>&);                                   \
    template void       clear_tallies(SandTallies<Exec>&);                                                             \
    template void       request_totals(const Exec&, SandTallies<Exec>&, const mpm::Pages<Exec>&);                      \
    template SandReport take_report(const Exec&, SandTallies<Exec>&, const Communicator*)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template SandCensus take_census(const Exec&, SandTallies<Exec>&, const mpm::PointsView<Real>&,                     \
                                    const mpm::PagesView&, const mpm::MaterialParameters<Real>*, const Communicator*); \
    template void       account_for_left(const Exec&, SandTallies<Exec>&, mpm::Points<Exec, Real>&, std::int64_t,      \
                                         mpm::PagesView, const mpm::MaterialParameters<Real>*, const Communicator*)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
