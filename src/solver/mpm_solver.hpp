#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "backend/async_readback.hpp"
#include "backend/reduce.hpp"
#include "decomp/balance.hpp"
#include "kernels/mpm/grid/grid.hpp"
#include "kernels/mpm/grid/seams.hpp"
#include "kernels/mpm/grid/wall_pages.hpp"
#include "kernels/mpm/pages/order.hpp"
#include "kernels/mpm/pages/relist.hpp"
#include "kernels/mpm/transfers/cell_divergence.hpp"
#include "kernels/mpm/transfers/cell_stress.hpp"
#include "kernels/mpm/transfers/gather.hpp"
#include "kernels/mpm/transfers/scatter.hpp"
#include "solver/point_copy.hpp"
#include "solver/sand_ranks.hpp"
#include "solver/sand_report.hpp"
#include "solver/sand_sleep.hpp"
#include "world/terrain_bins.hpp"
#include "world/world.hpp"

namespace tread::solver
{

class StateFile;

/// Sand of a scene on one backend: points, pages, grid and the four calls of an MPM step. With a decomposition a rank
/// holds the points of the pages that it owns, every call is collective, and reports cover all ranks.
template<class Exec, class Real>
class MpmSolver
{
public:
    /// `decomposition`: ownership of pages; null on one rank. If the world's points have ids, it holds this rank's
    /// points only.
    MpmSolver(const Exec& exec, const scene::Scene& scene, const world::World& world, mpm::PointFields fields,
              decomp::Decomposition<Exec>* decomposition = nullptr);

    /// Number of points of this rank.
    std::int64_t count() const { return points_.count + (sleep_ ? sleep_->points().count : 0); }

    /// Points that are awake, and their pages.
    mpm::PointsView<Real>    view() { return points_.view(); }
    mpm::Points<Exec, Real>& points() { return points_; }
    mpm::PagesView           pages() const;
    const mpm::GridGeometry& geometry() const { return geometry_; }

    /// Step 1. Lists points by page and cell, unless the last report says that none has left its cell. After many
    /// relistings it sorts points in memory into the order of the list, without synchronisation. When the report says
    /// that a point approaches pages that are not listed, it sorts points and rebuilds the pages, with
    /// synchronisation.
    void order();

    /// Sleep, after order(). sleep_is_due: whether to update which pages sleep before a step with this damping, when
    /// nothing is faster than `speed` (m/s). With damping none sleeps.
    bool sleep_is_due(double speed, double damping) const { return sleep_ && sleep_->is_due(speed, damping); }
    void update_sleeping_pages(const std::vector<BodyReach>& bodies, double damping);

    /// Mean share of the points that have slept so far; empty where sleep is off.
    std::optional<double> mean_asleep() const;

    /// Call after pages have got new owners, with no step since the last report: the next order() sorts and migrates
    /// the points.
    void follow_owners();

    /// Adds the work of this rank's points to the pages where they were last listed.
    void add_loads(decomp::PageLoads& loads) const;

    /// Counts reorderings in memory; a change invalidates indices into point arrays.
    std::int64_t reorder_count() const { return reorder_count_; }
    /// Number of points of all ranks that changed rank in the last order(), and this rank's, by destination rank.
    std::int64_t                                   migrated() const { return migrated_; }
    const std::vector<std::vector<std::uint32_t>>& migrated_out() const { return ranks_->migration().migrated_out(); }

    /// Step 4. P2G. On several ranks it begins with the nodes that ranks share.
    void scatter();

    /// Between 4 and 5, on several ranks: completes the halo exchange and adds the other ranks' parts.
    void share() { ranks_->halo().finish(); }

    /// Step 5. Grid momentum, with local damping (0 = none).
    void update_grid(double dt, double damping);

    /// Step 6. G2P and stress.
    void gather(double dt);

    /// Report of the steps since the last one; synchronises. Due before a point can leave the listed pages: a report
    /// of several steps whose cell_change() is CellChange::lost comes too late.
    SandReport report();

    /// Requests the report early, so that one synchronisation serves several readbacks.
    void request_report();

    /// Census of the present state; synchronises. Points that have left the domain count with their values when they
    /// left.
    SandCensus census();

    /// kg, of awake points in the domain, at the last census or since points last left or fell asleep.
    double mass() const { return mass_ - (sleep_ ? sleep_->census().mass : 0); }

    /// m, positions of this rank's points in memory order.
    std::vector<Vec3<double>> positions() const;

    /// Adds this rank's points, sleeping ones included, as cubes of their present volume.
    void add_to(world::TerrainBins& bins) const;

    /// Copies the fields of this rank's points that a snapshot shows.
    void copy_to(PointCopy<Exec, Real>& copy) const { copy.take(exec_, all_points()); }

    /// Saves to a checkpoint, or loads into sand of the same scene, built as `built`. Call right after a report; does
    /// not change later results. Collective.
    void transfer(StateFile& file, const world::HostPoints& built);

private:
    void transfer_points(StateFile& file, mpm::Points<Exec, Real>& points, const std::string& folder,
                         std::vector<bool>& seen);
    void transfer_lists(StateFile& file, const world::HostPoints& built, std::vector<bool>& seen);
    /// Awake points, then sleeping ones.
    std::vector<const mpm::Points<Exec, Real>*> all_points() const;

    void           restore_lasting(mpm::Points<Exec, Real>& points, const world::HostPoints& built);
    void           resume_lists();
    void           make_room();
    void           upload(const world::HostPoints& host, mpm::PointFields fields);
    void           order_in_memory();
    void           keep_account_of(std::int64_t left);
    void           list_anew();
    void           clear_tallies();
    mpm::MovesView moves();
    template<class Launch>
    void for_each_level(const Launch& launch);

    Exec                                       exec_;
    mpm::GridGeometry                          geometry_;
    mpm::GridWalls                             walls_;
    Vec3<Real>                                 gravity_;
    Real                                       mass_floor_;
    mpm::Points<Exec, Real>                    points_;
    mpm::Pages<Exec>                           pages_;
    mpm::OrderScratch<Exec, Real>              order_scratch_;
    mpm::RelistScratch<Exec>                   relist_scratch_;
    Array<Exec, std::uint16_t>                 moves_to_;
    Array<Exec, std::int32_t>                  move_counts_;
    Array<Exec, std::int64_t>                  changed_in_;
    mpm::WallPages<Exec, Real>                 wall_pages_;
    std::optional<SandRanks<Exec, Real>>       ranks_; ///< only on several ranks
    std::optional<SandSleep<Exec, Real>>       sleep_; ///< only if the scene has sleep.distance
    std::optional<mpm::Seams<Exec, Real>>      seams_; ///< only on a refined grid
    Array<Exec, Real>                          tiles_;
    Array<Exec, Real>                          motion_;
    Array<Exec, double>                        grid_rows_;
    Array<Exec, double>                        point_rows_;
    Array<Exec, double>                        peak_rows_;
    Array<Exec, double>                        census_rows_;
    Array<Exec, double>                        totals_; ///< totals of a census, or ReportTotals
    Array<Exec, double>                        sums_scratch_;
    AsyncReadback<Exec, ReportTotals>          readback_;
    Array<Exec, mpm::MaterialParameters<Real>> materials_;
    double                                     pic_rate_;
    bool                                       cell_means_; ///< cell averages of volumetric strain, and of pressure
    Array<Exec, Real>                          cell_divergence_;
    Array<Exec, Real>                          shared_stress_;
    std::array<double, mpm::census_count>      left_{}; ///< census of points that have left the domain, of all ranks
    double                                     mass_          = 0;
    std::int64_t                               step_          = 0;     ///< number of the last step
    std::int64_t                               steps_         = 0;     ///< steps since the last report
    bool                                       requested_     = false; ///< the next report was requested
    mpm::CellChange                            cell_change_   = mpm::CellChange::lost; ///< up to the last report
    bool                                       listed_        = false; ///< points were listed since the last step
    int                                        relists_       = 0;     ///< relistings since the last sort in memory
    std::int64_t                               reorder_count_ = 0;
    std::int64_t                               migrated_      = 0; ///< points that changed rank in the last order()
};

} // namespace tread::solver
