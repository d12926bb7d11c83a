#pragma once

#include <optional>

#include "backend/async_readback.hpp"
#include "kernels/dem/motion/impulses.hpp"
#include "kernels/dem/motion/totals.hpp"
#include "solver/bodies/body_commands.hpp"
#include "solver/bodies/body_state.hpp"
#include "solver/bodies/pair_lists.hpp"
#include "solver/ledger/ledger.hpp"

namespace tread::solver
{

/// Sums and maxima over all bodies of this rank. Holds doubles only.
struct BodyReportSums
{
    dem::BodyActivity most;
    dem::BodyActivity all;
    dem::BodyTotal    total;
};

/// Number of totals: of each body that this rank has a row for and, on several ranks, of all that have gone.
template<class Exec>
std::int64_t total_rows(const BodyState<Exec>& state)
{
    return state.bodies.position.size() + (state.ranks ? 1 : 0);
}

/// Report of the steps since the last one: totals of the substeps, sums over bodies, and their readbacks.
template<class Exec>
struct BodyReports
{
    /// `rows`: of totals (total_rows), here and below.
    BodyReports(const Exec& exec, std::int64_t rows);

    /// Takes the totals along where rows have changed.
    void follow(const RowMoves<Exec>& moves);

    /// Saves or loads the totals where the state is exact. Otherwise loading sets them to zero: their increase was
    /// accounted for when the state was saved. `rebuilt_overlap` is in bodies/steps.
    void transfer(StateFile& file, std::int64_t rows);

    dem::BodyTotals<Exec>                         totals;   ///< of the substeps
    dem::BodyTotal                                taken{};  ///< sum of the totals at the last report
    Array<Exec, double>                           sums;     ///< BodyReportSums
    std::optional<Array<Exec, dem::BodyActivity>> activity; ///< of the requested report
    AsyncReadback<Exec, BodyReportSums>           sums_on_host;
    AsyncReadback<Exec, double>                   displacement_on_host; ///< largest share of an allowed displacement
    AsyncReadback<Exec, double>                   overlap_on_host;
    double rebuilt_overlap = 0; ///< largest overlap over radius of lists that were rebuilt since the last report
};

/// Enqueues the sums of a report and their readback.
template<class Exec>
void request_report(BodyState<Exec>& state, BodyReports<Exec>& reports, PairLists<Exec>& lists);

/// What a report needs to know of the step besides the bodies.
struct ReportedStep
{
    double        time;     ///< s, for messages
    double        substep;  ///< s, duration of the last substep
    CommandTotals commands; ///< since the last report
};

/// Takes the requested report of all ranks' bodies; synchronises. NumericalError (body_checks.hpp) if the state is not
/// valid. Collective.
template<class Exec>
RigidReport take_report(BodyState<Exec>& state, BodyReports<Exec>& reports, const PairLists<Exec>& lists,
                        const ReportedStep& step);

/// Checks the bodies and notes the overlap of the present list, before a search resets it; synchronises. Errors are
/// those of take_report. Collective.
template<class Exec>
void check_before_search(BodyState<Exec>& state, BodyReports<Exec>& reports, double time);

} // namespace tread::solver
