#pragma once

#include "decomp/balance.hpp"
#include "decomp/grid_halo.hpp"
#include "decomp/migration.hpp"

namespace tread::solver
{

class StateFile;

/// What sand on several ranks has beyond sand on one: points that change ranks, pages that change owners, nodes that
/// ranks share. Collective.
template<class Exec, class Real>
class SandRanks
{
public:
    SandRanks(decomp::Decomposition<Exec>& decomposition, double threshold);

    /// Brings all points to the owners of their pages, once, and orders them there (mpm::order_points); finds out what
    /// is shared, and whether other owners are worth it, to whom points go in the next call. `step`: number of the last
    /// one.
    void order(mpm::Points<Exec, Real>& points, mpm::Pages<Exec>& pages, const mpm::GridGeometry& geometry,
               const mpm::GridWalls& walls, mpm::OrderScratch<Exec, Real>& scratch, std::int64_t step);

    /// Whether order() is to be called although no point asks to be sorted: pages have other owners, or it may be time
    /// for that. The same on all ranks.
    bool is_due(std::int64_t step) const;

    /// Points of all ranks that changed their rank in the last order().
    std::int64_t                         moved() const { return moved_; }
    const decomp::Migration<Exec, Real>& migration() const { return migration_; }

    /// Who owns which page, and what is known of the balance, into a checkpoint or out of it; the same number of ranks.
    void transfer(StateFile& file);

    /// After that, with the pages that were ordered then.
    void resume(mpm::Pages<Exec>& pages, const mpm::GridWalls& walls) { halo_.plan(pages, walls); }

    decomp::GridHalo<Exec, Real>& halo() { return halo_; }
    const decomp::BalanceRow&     balance() const { return balance_; }
    const Communicator&           communicator() const { return decomposition_.communicator; }

private:
    bool rebalance(const mpm::Pages<Exec>& pages, std::int64_t step);

    decomp::Decomposition<Exec>&  decomposition_;
    decomp::Migration<Exec, Real> migration_;
    decomp::GridHalo<Exec, Real>  halo_;
    decomp::BalanceRule           rule_;
    decomp::BalanceRow            balance_;
    std::int64_t                  moved_       = 0;
    bool                          dealt_out_   = false; ///< pages have had other owners since the last order()
    std::int64_t                  partitioned_ = 0;     ///< the step before which pages were last dealt out
    std::int64_t                  not_before_  = 0;     ///< the step from which that may be thought of again
};

} // namespace tread::solver
