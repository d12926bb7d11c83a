#pragma once

#include <cstdint>
#include <vector>

#include "decomp/decomposition.hpp"
#include "decomp/halo_plan.hpp"

namespace tread::decomp
{

/// How the work of a run fell to its ranks so far.
struct BalanceRow
{
    double       imbalance    = 1; ///< largest load over the mean, when points were last sorted
    std::int64_t repartitions = 0;
    std::int64_t points_moved = 0; ///< from rank to rank

    std::vector<double> loads; ///< of the ranks, when points were last sorted
};

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

/// Collective. `key`, ascending, and `load` (points) of the pages that this rank owns. Where it is due and worth it,
/// pages get other owners, those without points none; returns whether they did: points have to follow. `row` is brought
/// up to date, as if they had.
template<class Exec>
bool rebalance(Decomposition<Exec>& decomposition, const BalanceRule& rule, const PageKeys& key,
               const std::vector<double>& load, std::int64_t steps, BalanceRow& row);

} // namespace tread::decomp
