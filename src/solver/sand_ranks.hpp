#pragma once

#include "decomp/balance.hpp"
#include "decomp/grid_halo.hpp"
#include "decomp/migration.hpp"

namespace tread::solver
{

/// What sand on several ranks has beyond sand on one: points that change ranks, pages that change owners, nodes that
/// ranks share. Collective.
template<class Exec, class Real>
class SandRanks
{
public:
    SandRanks(decomp::Decomposition<Exec>& decomposition, double threshold);

    /// Brings all points to the owners of their pages and orders them there (mpm::order_points), with other owners
    /// where that is worth it, and finds out what is shared. `step`: number of the next one.
    void order(mpm::Points<Exec, Real>& points, mpm::Pages<Exec>& pages, const mpm::GridGeometry& geometry,
               const mpm::GridWalls& walls, mpm::OrderScratch<Exec, Real>& scratch, std::int64_t step);

    /// Whether it may be time for other owners although no point asks to be sorted. The same on all ranks.
    bool is_due(std::int64_t step) const;

    decomp::GridHalo<Exec, Real>& halo() { return halo_; }
    const decomp::BalanceRow&     balance() const { return balance_; }
    const Communicator&           communicator() const { return decomposition_.communicator; }

private:
    void move_and_order(mpm::Points<Exec, Real>& points, mpm::Pages<Exec>& pages, const mpm::GridGeometry& geometry,
                        mpm::OrderScratch<Exec, Real>& scratch);
    bool rebalance(const mpm::Pages<Exec>& pages, std::int64_t step);

    decomp::Decomposition<Exec>&  decomposition_;
    decomp::Migration<Exec, Real> migration_;
    decomp::GridHalo<Exec, Real>  halo_;
    decomp::BalanceRule           rule_;
    decomp::BalanceRow            balance_;
    std::int64_t                  partitioned_ = 0; ///< the step before which pages were last dealt out
    std::int64_t                  not_before_  = 0; ///< the step from which that may be thought of again
};

} // namespace tread::solver
