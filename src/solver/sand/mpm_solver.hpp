#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "decomp/balance.hpp"
#include "kernels/contact/beds.hpp"
#include "solver/ledger/sand_report.hpp"
#include "solver/ranks/sand_ranks.hpp"
#include "solver/sand/point_copy.hpp"
#include "solver/sand/point_order.hpp"
#include "solver/sand/sand_grid.hpp"
#include "solver/sand/sand_laws.hpp"
#include "solver/sand/sand_sleep.hpp"
#include "solver/sand/sand_tallies.hpp"
#include "world/terrain_bins.hpp"
#include "world/world.hpp"

namespace tread::solver
{

class StateFile;

/// Sand of a scene on one backend: the calls of an MPM step, in order, on points, their lists, the grid, the laws and
/// the tallies. With a decomposition a rank holds the points of the pages that it owns, every call is collective, and
/// reports cover all ranks.
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
    mpm::PagesView           pages() const { return grid_.view(order_.pages); }
    const mpm::GridGeometry& geometry() const { return grid_.geometry; }

    /// Step 1. Lists points by page and cell, unless the last report says that none has left its cell. After many
    /// relistings it sorts points in memory into the order of the list, without synchronisation. When the report says
    /// that a point approaches pages that are not listed, it sorts points and rebuilds the pages, with
    /// synchronisation.
    void order();

    /// Whether sand of this scene may sleep.
    bool may_sleep() const { return sleep_.has_value(); }

    /// Sets gravity, m/s2.
    void set_gravity(const Vec3<double>& gravity)
    {
        grid_.gravity = gravity.cast<Real>();
        if (sleep_) { sleep_->set_gravity(gravity.norm()); }
    }

    /// Who follows the sleep of sand; empty: nobody.
    struct SleepFollower
    {
        std::function<void(const contact::SandPages&)> choose; ///< gets the pages that sleep from now on, and others
        std::function<void(const SleepChange<Real>&)>  move;   ///< gets the points that moved, before they are sorted
    };

    /// Step 2, after order(). sleep_is_due: whether to update which pages sleep before a step with this damping, when
    /// nothing is faster than `speed` (m/s). With damping none sleeps. `bodies` keep the sand around them awake.
    bool sleep_is_due(double speed, double damping) const { return sleep_ && sleep_->is_due(speed, damping); }
    void update_sleeping_pages(const std::vector<BodyReach>& bodies, double damping, const SleepFollower& follow);

    /// Wakes the sand near these bodies, if any sleeps there.
    void wake_near(const std::vector<BodyReach>& bodies, const SleepFollower& follow);

    /// Number of sleeping points of this rank.
    std::int64_t asleep() const { return sleep_ ? sleep_->points().count : 0; }

    /// Mean share of the points of all ranks that have slept so far; empty where sleep is off.
    std::optional<double> mean_asleep() const;

    /// Call after pages have got new owners, with no step since the last report: sleeping points migrate at once, and
    /// the next order() sorts and migrates the others. Returns how many sleeping points of all ranks changed rank;
    /// those of this rank are migrated_out().
    std::int64_t follow_owners();

    /// Adds the work of this rank's points to the pages where they were last listed, and next to none to its sleeping
    /// pages.
    void add_loads(decomp::PageLoads& loads) const;

    /// Counts reorderings in memory; a change invalidates indices into point arrays.
    std::int64_t reorder_count() const { return order_.reorder_count; }
    /// Number of points of all ranks that changed rank in the last order(), and this rank's, by destination rank.
    std::int64_t                                   migrated() const { return order_.migrated; }
    const std::vector<std::vector<std::uint32_t>>& migrated_out() const { return ranks_->migration().migrated_out(); }

    /// Step 5. P2G. On several ranks it begins with the nodes that ranks share.
    void scatter();

    /// After scatter(), on several ranks: completes the halo exchange and adds the other ranks' parts.
    void share() { ranks_->halo().finish(); }

    /// Step 6. Grid momentum, with local damping (0 = none); then G2P and stress.
    void update_grid(double dt, double damping);
    void gather(double dt);

    /// Step 7. Report of the steps since the last one; synchronises. Due before a point can leave the listed pages: a
    /// report of several steps whose cell_change() is CellChange::lost comes too late.
    SandReport report();

    /// Requests the report early, so that one synchronisation serves several readbacks.
    void request_report();

    /// Census of the present state; synchronises. Points that have left the domain count with their values when they
    /// left.
    SandCensus census();

    /// kg, of awake points in the domain, at the last census or since points last left or fell asleep.
    double mass() const { return tallies_.mass - (sleep_ ? sleep_->census().mass : 0); }

    /// This rank's points: awake ones, then sleeping ones where sand may sleep.
    std::vector<const mpm::Points<Exec, Real>*> all_points() const;

    /// m, positions of this rank's points in memory order.
    std::vector<Vec3<double>> positions() const;

    /// Adds this rank's points, sleeping ones included, as cubes of their present volume.
    void add_to(world::TerrainBins& bins) const;

    /// Copies the fields of this rank's points that a snapshot shows.
    void copy_to(PointCopy<Exec, Real>& copy) const { copy.take(exec_, all_points()); }

    /// Saves to a checkpoint, or loads into sand of the same scene, built as `built`. Call right after a report; does
    /// not change later results. Collective.
    void transfer(StateFile& file, const world::Sand& built);

private:
    void transfer_lists(StateFile& file, const world::Sand& built, std::vector<bool>& seen);
    void order_in_memory();
    void make_room();
    void follow_moves(const std::optional<SleepMoves>& moves, const SleepFollower& follow);

    typename SandSleep<Exec, Real>::Sand sleeping_sand()
    {
        return {points_, grid_.geometry, laws_.materials.data(), order_.scratch};
    }

    const Communicator* communicator() const { return ranks_ ? &ranks_->communicator() : nullptr; }

    Exec                                 exec_;
    mpm::Points<Exec, Real>              points_;
    PointOrder<Exec, Real>               order_;
    SandGrid<Exec, Real>                 grid_;
    SandLaws<Exec, Real>                 laws_;
    SandTallies<Exec>                    tallies_;
    std::optional<SandRanks<Exec, Real>> ranks_; ///< only on several ranks
    std::optional<SandSleep<Exec, Real>> sleep_; ///< only if the scene has sleep.distance
};

} // namespace tread::solver
