#pragma once

#include "decomp/grid_halo.hpp"
#include "decomp/migration.hpp"

namespace tread::solver
{

class StateFile;

/// What sand on several ranks has beyond sand on one: points that change ranks, and nodes that ranks share. Collective.
template<class Exec, class Real>
class SandRanks
{
public:
    explicit SandRanks(decomp::Decomposition<Exec>& decomposition);

    /// Brings all points to the owners of their pages, and orders them there (mpm::order_points); finds out what is
    /// shared. Gives how many points of this rank have left the domain.
    std::int64_t order(mpm::Points<Exec, Real>& points, mpm::Pages<Exec>& pages, const mpm::GridGeometry& geometry,
                       const mpm::GridWalls& walls, mpm::OrderScratch<Exec, Real>& scratch);

    /// Points of all ranks that changed their rank in the last order().
    std::int64_t                         moved() const { return moved_; }
    const decomp::Migration<Exec, Real>& migration() const { return migration_; }

    /// Who owns which page, into a checkpoint or out of it; the same number of ranks.
    void transfer(StateFile& file);

    /// After that, with the pages that were ordered then.
    void resume(mpm::Pages<Exec>& pages, const mpm::GridWalls& walls) { halo_.plan(pages, walls); }

    decomp::GridHalo<Exec, Real>& halo() { return halo_; }
    const Communicator&           communicator() const { return decomposition_.communicator; }

private:
    decomp::Decomposition<Exec>&  decomposition_;
    decomp::Migration<Exec, Real> migration_;
    decomp::GridHalo<Exec, Real>  halo_;
    std::int64_t                  moved_ = 0;
};

} // namespace tread::solver
