#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "decomp/decomposition.hpp"

namespace tread::decomp
{

/// How the work of a run fell to its ranks so far.
struct BalanceRow
{
    double       imbalance    = 1; ///< largest load over the mean, when points or bodies last changed their rank
    std::int64_t repartitions = 0;
    std::int64_t points_moved = 0; ///< from rank to rank

    std::vector<double> loads; ///< of the ranks, in points, at the same time
};

/// What a rank has on which pages, in points. A page may be in the loads of several ranks, and need not be owned by the
/// one that has most of it: what is on it moves before it changes its rank.
using PageLoads = std::map<std::uint64_t, double>;

/// Decides from counts alone, never from clocks, when pages are to be dealt out anew: the same on every machine.
class BalanceRule
{
public:
    explicit BalanceRule(double threshold)
        : threshold_(threshold)
    {
    }

    /// Whether to look for a better partition at all. `loads` of the ranks, in points; `steps` since the last one.
    bool is_due(const std::vector<double>& loads, std::int64_t steps) const;

    /// Whether loads `now` are so much worse than those `after` that as many steps as went by since the last partition
    /// save more than it costs to move `moved` points. Work in points times steps.
    bool is_worth(const std::vector<double>& now, const std::vector<double>& after, double moved,
                  std::int64_t steps) const;

private:
    double threshold_; ///< of the largest load over the mean
};

/// Largest over mean; 1 without load.
double imbalance_of(const std::vector<double>& loads);

/// Watches how the work falls to the ranks, and gives pages to others of them. Calls are collective.
template<class Exec>
class Balance
{
public:
    Balance(Decomposition<Exec>& decomposition, double threshold);

    /// Whether repartition() is worth a call before step number `step`. The same on all ranks, without a message.
    bool is_due(std::int64_t step) const;

    /// All pages that have load get owners anew, where that saves more than it costs; returns whether they did: what is
    /// on them has to follow before anybody asks for an owner again. `own`: of this rank.
    bool repartition(const PageLoads& own, std::int64_t step);

    /// After points or bodies may have changed their rank: what this one has now, and how many points of all did.
    void note(double load, std::int64_t points_moved);

    const BalanceRow& row() const { return state_.row; }

    /// All that it knows, to go on with later.
    struct State
    {
        BalanceRow   row;
        std::int64_t partitioned = 0; ///< the step before which pages were last dealt out
        std::int64_t not_before  = 0; ///< the step from which that may be thought of again
    };
    const State& state() const { return state_; }
    void         resume(State state) { state_ = std::move(state); }

private:
    Decomposition<Exec>& decomposition_;
    BalanceRule          rule_;
    State                state_;
};

} // namespace tread::decomp
