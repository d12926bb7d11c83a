#pragma once

#include <array>

#include "backend/async_readback.hpp"
#include "base/communicator.hpp"
#include "kernels/mpm/laws/material_parameters.hpp"
#include "solver/ledger/sand_report.hpp"

namespace tread::solver
{

/// Sums over grid nodes and points and peaks of points since the last report, their copy on the host, and the mass and
/// energy that a census finds.
template<class Exec>
struct SandTallies
{
    explicit SandTallies(const Exec& exec);

    Array<Exec, double> grid_rows;    ///< [node pages][mpm::tally_width(mpm::grid_sums)]
    Array<Exec, double> point_rows;   ///< [point pages][mpm::tally_width(mpm::point_sums)]
    Array<Exec, double> peak_rows;    ///< [point pages][mpm::point_peaks]
    Array<Exec, double> census_rows;  ///< [point pages][mpm::census_count]
    Array<Exec, double> totals;       ///< totals of a census, or ReportTotals
    Array<Exec, double> sums_scratch; ///< scratch memory of sum_rows

    AsyncReadback<Exec, ReportTotals>     readback;
    std::array<double, mpm::census_count> left{};    ///< census of points that have left the domain, of all ranks
    double                                mass  = 0; ///< kg, in the domain at the last census, less what has left since
    std::int64_t                          steps = 0; ///< since the last report
    bool                                  requested = false; ///< the next report was requested
};

/// Allocates and clears the sums and peaks of `pages`.
template<class Exec>
void resize_tallies(SandTallies<Exec>& tallies, const mpm::Pages<Exec>& pages);

/// Sets the sums and peaks to zero.
template<class Exec>
void clear_tallies(SandTallies<Exec>& tallies);

/// Adds up the sums and peaks of the pages, and requests the copy of the totals to the host.
template<class Exec>
void request_totals(const Exec& exec, SandTallies<Exec>& tallies, const mpm::Pages<Exec>& pages);

/// Makes the report of the requested totals, over all ranks; synchronises. Points that have left the domain count with
/// their energy when they left. `communicator`: null on one rank.
template<class Exec>
SandReport take_report(const Exec& exec, SandTallies<Exec>& tallies, const Communicator* communicator);

/// Census of the listed points of all ranks; synchronises. `communicator`: null on one rank.
template<class Exec, class Real>
SandCensus take_census(const Exec& exec, SandTallies<Exec>& tallies, const mpm::PointsView<Real>& points,
                       const mpm::PagesView& pages, const mpm::MaterialParameters<Real>* materials,
                       const Communicator* communicator);

/// Accounts for the `count` points of this rank that have left the domain and are stored behind the others. Collective;
/// `communicator`: null on one rank.
template<class Exec, class Real>
void account_for_left(const Exec& exec, SandTallies<Exec>& tallies, mpm::Points<Exec, Real>& points, std::int64_t count,
                      mpm::PagesView pages, const mpm::MaterialParameters<Real>* materials,
                      const Communicator* communicator);

} // namespace tread::solver
