#pragma once

#include "decomp/grid_halo.hpp"
#include "decomp/migration.hpp"

namespace tread::solver
{

class StateFile;

/// How far points may be outside the pages of their rank before they are sorted.
enum class Outside
{
    anywhere,  ///< on the pages that the rank lists
    near_pages ///< mpm::farthest_outside, so that few ranks hold a body
};

/// What sand needs on several ranks only: migration of points, and exchange of shared nodes. Collective.
template<class Exec, class Real>
class SandRanks
{
public:
    SandRanks(decomp::Decomposition<Exec>& decomposition, Outside outside);

    /// Migrates all points to the owners of their pages, sorts them there (mpm::order_points), and plans the exchange
    /// of shared nodes. Returns the number of this rank's points that have left the domain.
    std::int64_t order(mpm::Points<Exec, Real>& points, mpm::Pages<Exec>& pages, const mpm::GridGeometry& geometry,
                       const mpm::GridWalls& walls, mpm::OrderScratch<Exec, Real>& scratch);

    /// Migrates points that are not sorted to the owners of their pages; returns how many of all ranks changed rank.
    std::int64_t migrate(mpm::Points<Exec, Real>& points, const mpm::GridGeometry& geometry,
                         mpm::OrderScratch<Exec, Real>& scratch)
    {
        return migration_.run(points, geometry, scratch);
    }

    /// Whether this rank owns a page.
    bool owns(std::uint64_t page) const { return decomposition_.owners.owner(page) == decomposition_.rank(); }

    /// Number of points of all ranks that changed rank in the last order().
    std::int64_t                         moved() const { return moved_; }
    const decomp::Migration<Exec, Real>& migration() const { return migration_; }

    /// Restores far cells and the halo plan for loaded pages, whose owners are known.
    void resume(mpm::Pages<Exec>& pages, const mpm::GridWalls& walls);

    decomp::GridHalo<Exec, Real>& halo() { return halo_; }
    const Communicator&           communicator() const { return decomposition_.communicator; }

private:
    void mark_far_cells(mpm::Pages<Exec>& pages);

    decomp::Decomposition<Exec>&  decomposition_;
    Outside                       outside_;
    decomp::Migration<Exec, Real> migration_;
    decomp::GridHalo<Exec, Real>  halo_;
    std::int64_t                  moved_ = 0;
};

} // namespace tread::solver
