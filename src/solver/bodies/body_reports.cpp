#include "solver/bodies/body_reports.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "backend/reduce.hpp"
#include "base/errors.hpp"
#include "kernels/dem/contact/contact_limits.hpp"
#include "solver/bodies/body_checks.hpp"
#include "solver/ranks/over_ranks.hpp"
#include "solver/ranks/row_arrays.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

/// Adds the increase of the totals since the last report, and what commands have put in.
void add_increase(RigidReport& report, const dem::BodyTotal& now, const dem::BodyTotal& last, const ReportedStep& step,
                  const Vec3<double>& gravity)
{
    report.wall_impulse    = now.wall_impulse - last.wall_impulse;
    report.damping_impulse = now.damping_impulse - last.damping_impulse;
    report.driver_impulse  = now.holding_impulse - last.holding_impulse + step.commands.impulse;
    report.friction        = now.friction - last.friction;
    report.restitution     = now.restitution - last.restitution;
    report.damped          = now.damping - last.damping;
    // Velocities are those of half a substep earlier; so are commanded ones.
    report.driver_work = now.holding_work - last.holding_work + step.commands.work +
                         0.5 * step.substep * gravity.dot(step.commands.impulse);
    report.scaling_work = now.scaling_work - last.scaling_work;
    report.sand_work    = now.sand_work - last.sand_work;
}

/// Checks this rank's bodies. A maximum of speeds hides a value that is not finite; a sum does not.
template<class Exec>
void check(BodyState<Exec>& state, BodyReports<Exec>& reports, const PairLists<Exec>& lists, RigidReport& report,
           double sum_of_speeds, double time)
{
    if (!std::isfinite(report.net_force) || !std::isfinite(sum_of_speeds))
    {
        require_finite(state, time);
        throw NumericalError(fmt::format("t = {:.6g} s: the sum of the forces on bodies is not a number", time));
    }
    if (!state.has_contact) { return; }
    require_resolved(state, *reports.activity, report.largest_speed, report.substep, time);
    if (!lists.checked_within_step)
    {
        require_listed(state, lists.displacements, reports.displacement_on_host.get(), time);
    }
    const double earlier = std::exchange(reports.rebuilt_overlap, 0.0), overlap = reports.overlap_on_host.get();
    require_shallow(state, overlap, time);
    report.overlap = std::max(earlier, overlap);
}

template<class Exec>
void clear(BodyReports<Exec>& reports)
{
    reports.totals.fill_zero();
    reports.taken = read(reports.totals.exec(), reports.totals.data()); // zero for all bodies
}

/// Begins rows of bodies that have come with nothing.
template<class Exec>
void clear_rows(const Exec& exec, dem::BodyTotals<Exec>& totals, const std::vector<std::int32_t>& come)
{
    Array<Exec, std::int32_t> rows(exec, "rows of bodies that have come");
    rows.assign(come);
    dem::BodyTotals<Exec> nothing(exec, "totals of bodies that have come", rows.size());
    nothing.fill_zero();
    decomp::unpack_rows(exec, reinterpret_cast<const std::uint32_t*>(nothing.data()), rows.size(),
                        decomp::columns(totals.data()), rows.data(), 0);
}

} // namespace

template<class Exec>
BodyReports<Exec>::BodyReports(const Exec& exec, std::int64_t rows)
    : totals(exec, "body totals", rows)
    , sums(exec, "body sums", sizeof(BodyReportSums) / sizeof(double))
    , sums_on_host(exec, "body sums on the host")
    , displacement_on_host(exec, "body displacement on the host")
    , overlap_on_host(exec, "body overlap on the host")
{
    clear(*this);
}

template<class Exec>
void BodyReports<Exec>::follow(const RowMoves<Exec>& moves)
{
    const Exec&               exec = totals.exec();
    std::vector<std::int32_t> gone = moves.gone;
    gone.push_back(static_cast<std::int32_t>(totals.size() - 1));
    Array<Exec, std::int32_t> rows(exec, "rows of bodies that have gone");
    dem::BodyTotals<Exec>     theirs(exec, "totals of bodies that have gone", static_cast<std::int64_t>(gone.size()));
    rows.assign(gone);
    decomp::pack_rows(exec, decomp::columns(totals.data()), rows.data(), rows.size(),
                      reinterpret_cast<std::uint32_t*>(theirs.data()));
    const std::vector<dem::BodyTotal> of_gone = theirs.to_host();

    take_rows(exec, moves.from, totals, 1);
    clear_rows(exec, totals, moves.come);
    std::array<double, dem::body_total_width> sum{};
    for (const dem::BodyTotal& total : of_gone)
    {
        const auto* values = reinterpret_cast<const double*>(&total);
        for (std::size_t c = 0; c < sum.size(); ++c) { sum[c] += values[c]; }
    }
    copy_from_host(exec, totals.data() + moves.from.size(), sum.data(), sizeof(sum));
}

template<class Exec>
void BodyReports<Exec>::transfer(StateFile& file, std::int64_t rows)
{
    if (file.exact())
    {
        file.own("bodies/totals", totals, accept::all(accept::rows(static_cast<std::size_t>(rows)), accept::finite()));
        file.doubles("bodies/taken", taken);
    }
    else if (file.loads())
    {
        totals.resize(rows);
        clear(*this);
    }
}

template<class Exec>
void request_report(BodyState<Exec>& state, BodyReports<Exec>& reports, PairLists<Exec>& lists)
{
    const Exec& exec     = state.exec;
    auto&       activity = reports.activity.emplace(exec, "body activity", state.bodies.position.size());
    dem::measure_activity(exec, state.view(), state.tables.bounding_radii.data(), state.gravity, activity.data());
    const double* values = reinterpret_cast<const double*>(activity.data());
    const double* totals = reinterpret_cast<const double*>(reports.totals.data());
    constexpr int width  = sizeof(dem::BodyActivity) / sizeof(double);
    double*       most   = reports.sums.data();
    largest_of_rows(exec, values, activity.size(), width, most);
    sum_rows(exec, values, activity.size(), width, most + width);
    sum_rows(exec, totals, reports.totals.size(), dem::body_total_width, most + 2 * width);
    reports.sums_on_host.request(reinterpret_cast<const BodyReportSums*>(most));
    if (!state.has_contact) { return; }
    const dem::BodyLaw& law = state.tables.law;
    if (!lists.checked_within_step)
    {
        reports.displacement_on_host.request(dem::largest_displacement(
            exec, lists.displacements, state.view(), law.templates, state.pairs.displacement.view(), lists.age));
    }
    reports.overlap_on_host.request(dem::largest_overlap(exec, state.pairs, state.view(), law));
}

template<class Exec>
RigidReport take_report(BodyState<Exec>& state, BodyReports<Exec>& reports, const PairLists<Exec>& lists,
                        const ReportedStep& step)
{
    synchronize(state.exec);
    RigidReport          report;
    const BodyReportSums sums = reports.sums_on_host.get();
    add_increase(report, sums.total, std::exchange(reports.taken, sums.total), step, state.gravity);
    report.largest_speed = sums.most.speed;
    report.net_force     = sums.all.net_force;
    report.weight_power  = sums.all.weight_power;
    report.substep       = step.substep;
    check_on_ranks(state.communicator(), [&] { check(state, reports, lists, report, sums.all.speed, step.time); });
    reports.activity.reset();
    if (state.ranks)
    {
        decomp::combine(*state.communicator(), reinterpret_cast<double*>(&report), rigid_report_sums,
                        rigid_report_peaks);
    }
    return report;
}

template<class Exec>
void check_before_search(BodyState<Exec>& state, BodyReports<Exec>& reports, double time)
{
    check_on_ranks(state.communicator(),
                   [&]
                   {
                       require_finite(state, time);
                       const double overlap = read(
                           state.exec, dem::largest_overlap(state.exec, state.pairs, state.view(), state.tables.law));
                       require_shallow(state, overlap, time);
                       reports.rebuilt_overlap = std::max(reports.rebuilt_overlap, overlap);
                   });
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template struct BodyReports<Exec>;                                                                                 \
    template void        request_report(BodyState<Exec>&, BodyReports<Exec>&, PairLists<Exec>&);                       \
    template RigidReport take_report(BodyState<Exec>&, BodyReports<Exec>&, const PairLists<Exec>&,                     \
                                     const ReportedStep&);                                                             \
    template void        check_before_search(BodyState<Exec>&, BodyReports<Exec>&, double)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
