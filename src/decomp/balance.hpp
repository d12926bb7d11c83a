#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "decomp/decomposition.hpp"

namespace tread::decomp
{

/// Load balance of a run over its ranks so far.
struct BalanceRow
{
    double       imbalance    = 1; ///< largest load over the mean, at the last change of ranks
    std::int64_t repartitions = 0;
    std::int64_t points_moved = 0; ///< between ranks

    std::vector<double> loads; ///< of each rank, in points, at the same time
};

/// Load of one rank on each page, in points. Several ranks may have load on a page, and its owner need not have the
/// most: points move before their page's owner changes.
using PageLoads = std::map<std::uint64_t, double>;

/// Decides when to repartition, from counts alone and never from clocks, so that every machine decides alike.
class BalanceRule
{
public:
    /// `threshold`: bound on the largest load over the mean; `least`: load, in points, that takes a rank as long as any
    /// smaller one.
    explicit BalanceRule(double threshold, double least = 0)
        : threshold_(threshold)
        , least_(least)
    {
    }

    /// Whether to try a new partition at all. `loads`: of each rank, in points; `steps`: since the last partition.
    bool is_due(const std::vector<double>& loads, std::int64_t steps) const;

    /// Whether a new partition pays: over as many steps as the last one lasted, going from loads `now` to `after` must
    /// save more than moving `moved` points costs. Work is in points times steps.
    bool is_worth(const std::vector<double>& now, const std::vector<double>& after, double moved,
                  std::int64_t steps) const;

private:
    /// Loads by the time that they take.
    std::vector<double> felt(std::vector<double> loads) const;

    double threshold_;
    double least_;
};

/// Largest load over the mean; 1 if there is no load.
double imbalance_of(const std::vector<double>& loads);

/// Monitors the load of the ranks and repartitions pages. Calls are collective.
template<class Exec>
class Balance
{
public:
    Balance(Decomposition<Exec>& decomposition, const BalanceRule& rule);

    /// Whether repartition() should be called before step number `step`. The same on all ranks, without communication.
    bool is_due(std::int64_t step) const;

    /// Assigns new owners to all pages with load, if that pays; returns whether it did. Points and bodies must then
    /// migrate before the next query of an owner. `own`: loads of this rank.
    bool repartition(const PageLoads& own, std::int64_t step);

    /// Assigns new owners to all pages with load, whether that pays or not: for loads that the present partition was
    /// not made for. Nothing changes where nobody has load.
    void repartition_anew(const PageLoads& own, std::int64_t step);

    /// Records this rank's load and the number of points that migrated, on all ranks; call after points or bodies may
    /// have changed rank.
    void note(double load, std::int64_t points_moved);

    const BalanceRow& row() const { return state_.row; }

    /// State that a checkpoint stores.
    struct State
    {
        BalanceRow   row;
        std::int64_t partitioned = 0; ///< step before which pages were last repartitioned
        std::int64_t not_before  = 0; ///< first step at which a repartition may be tried again
    };
    const State& state() const { return state_; }
    void         resume(State state) { state_ = std::move(state); }

private:
    void assign(const std::vector<std::uint64_t>& pages, const PageRanks& ranks, std::int64_t step);

    Decomposition<Exec>& decomposition_;
    BalanceRule          rule_;
    State                state_;
};

} // namespace tread::decomp
