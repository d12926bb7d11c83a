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

/// The sand of a scene on one backend: points, pages, grid and the four calls of an MPM step. With a decomposition a
/// rank holds the points of the pages that it owns, every call is collective, and reports are of all ranks.
template<class Exec, class Real>
class MpmSolver
{
public:
    /// `decomposition`: who owns which page; null on one rank. A world whose points have ids has only this rank's.
    MpmSolver(const Exec& exec, const scene::Scene& scene, const world::World& world, mpm::PointFields fields,
              decomp::Decomposition<Exec>* decomposition = nullptr);

    /// Of this rank.
    std::int64_t count() const { return points_.count + (sleep_ ? sleep_->points().count : 0); }

    /// Those that do not sleep, and their pages.
    mpm::PointsView<Real>    view() { return points_.view(); }
    mpm::Points<Exec, Real>& points() { return points_; }
    mpm::PagesView           pages() const;
    const mpm::GridGeometry& geometry() const { return geometry_; }

    /// 1. Lists points by page and cell, unless the last report says that none has left its cell; after many such lists
    /// moves them in memory to where the list has them, without waiting. Sorts them and makes the pages anew, and
    /// waits, when the report says that one comes near pages that are not listed.
    void order();

    /// After order(), where sand may sleep: whether to look which of it does before a step with this damping, as
    /// nothing is faster than `speed` (m/s); and the look. With damping none sleeps.
    bool sleep_is_due(double speed, double damping) const { return sleep_ && sleep_->is_due(speed, damping); }
    void update_sleeping_pages(const std::vector<BodyReach>& bodies, double damping);

    /// Mean share of the points that slept so far; nothing where none may.
    std::optional<double> mean_asleep() const;

    /// After pages got other owners, with no step since the last report: the next order() sorts points anew, and so
    /// brings them there.
    void follow_owners();

    /// Adds what this rank has on its pages, where they were last listed.
    void add_loads(decomp::PageLoads& loads) const;

    /// How often points were moved in memory: what is known of them by their place holds while this stays.
    std::int64_t reorder_count() const { return reorder_count_; }
    /// Points that changed their rank in the last order(), of all ranks; and of this one, by rank that they went to.
    std::int64_t                                   migrated() const { return migrated_; }
    const std::vector<std::vector<std::uint32_t>>& migrated_out() const { return ranks_->migration().migrated_out(); }

    /// 4. P2G. On several ranks it begins with what they bring to the nodes that they share.
    void scatter();

    /// Between 4 and 5, on several ranks: waits for what the others bring, and adds it.
    void share() { ranks_->halo().finish(); }

    /// 5. Grid momentum, with local damping (0 = none).
    void update_grid(double dt, double damping);

    /// 6. G2P and stress.
    void gather(double dt);

    /// Of the steps since the last report; waits for them. Due before a point can have run ahead of the listed pages: a
    /// report of several steps whose cell_change() is CellChange::lost comes too late.
    SandReport report();

    /// Asks for the report already, so that one wait serves others' too.
    void request_report();

    /// Of the present state; waits for it. What has left the domain counts as it was when it left.
    SandCensus census();

    /// kg, of what is in the domain and does not sleep, at the last census or since more has left or fallen asleep.
    double mass() const { return mass_ - (sleep_ ? sleep_->census().mass : 0); }

    /// m, in memory order, of this rank.
    std::vector<Vec3<double>> positions() const;

    /// This rank's points, those that sleep among them, as cubes of their present volume.
    void add_to(world::TerrainBins& bins) const;

    /// Takes what a snapshot shows, of this rank.
    void copy_to(PointCopy<Exec, Real>& copy) const { copy.take(exec_, all_points()); }

    /// Into a checkpoint, or out of it into sand of the same scene, which was built as `built`. Due right after a
    /// report; changes nothing that comes after it. Collective.
    void transfer(StateFile& file, const world::HostPoints& built);

private:
    void transfer_points(StateFile& file, mpm::Points<Exec, Real>& points, const std::string& folder,
                         std::vector<bool>& seen);
    void transfer_lists(StateFile& file, const world::HostPoints& built, std::vector<bool>& seen);
    /// Those of the steps, then those that sleep.
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
    Array<Exec, double>                        totals_; ///< of a census, or ReportTotals
    Array<Exec, double>                        sums_scratch_;
    AsyncReadback<Exec, ReportTotals>          readback_;
    Array<Exec, mpm::MaterialParameters<Real>> materials_;
    double                                     pic_rate_;
    bool                                       cell_means_; ///< of volumetric strain, and of pressure
    Array<Exec, Real>                          cell_divergence_;
    Array<Exec, Real>                          shared_stress_;
    std::array<double, mpm::census_count>      left_{}; ///< census of what has left the domain, of all ranks
    double                                     mass_          = 0;
    std::int64_t                               step_          = 0;                     ///< number of the last one
    std::int64_t                               steps_         = 0;                     ///< since the last report
    bool                                       requested_     = false;                 ///< for the next
    mpm::CellChange                            cell_change_   = mpm::CellChange::lost; ///< in those before it
    bool                                       listed_        = false;                 ///< since the last step
    int                                        relists_       = 0; ///< since they were last ordered in memory
    std::int64_t                               reorder_count_ = 0;
    std::int64_t                               migrated_      = 0; ///< in the last order()
};

} // namespace tread::solver
