#pragma once

#include <optional>
#include <vector>

#include "kernels/mpm/laws/material_parameters.hpp"
#include "kernels/mpm/pages/leaving.hpp"
#include "scene/scene.hpp"
#include "solver/ledger/sand_report.hpp"
#include "solver/sand/page_watch.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Points that fell asleep and woke in an update: the last ones of either kind.
template<class Real>
struct SleepChange
{
    mpm::PointsView<Real> asleep;
    std::int64_t          first_fallen;
    mpm::PointsView<Real> awake;
    std::int64_t          first_woken;
};

/// Numbers of points that fell asleep and woke.
struct SleepMoves
{
    std::int64_t fallen = 0;
    std::int64_t woken  = 0;
};

/// Sleeping sand: whole pages whose points are kept apart from the awake ones, with stress and without velocity, and
/// cost no time. The grid nodes that they reach are held fixed. All ranks know which pages sleep, and each has the
/// points of its own; where it says so, calls are collective.
template<class Exec, class Real>
class SandSleep
{
public:
    /// The scene must have sleep.distance. `communicator`: null on one rank.
    SandSleep(const Exec& exec, const scene::Scene& scene, const world::World& world, mpm::PointFields fields,
              const Communicator* communicator);

    /// Sleeping points of this rank.
    mpm::Points<Exec, Real>&       points() { return points_; }
    const mpm::Points<Exec, Real>& points() const { return points_; }

    /// Keys of the sleeping pages of all ranks, ascending.
    const std::vector<std::uint64_t>& pages() const { return asleep_; }

    /// Census of the sleeping points of all ranks.
    const SandCensus& census() const { return census_; }

    /// Records a step of dt (s).
    void pass(double dt);

    /// Mean number of sleeping points of all ranks over time.
    double mean_count() const { return lived_ > 0 ? slept_ / lived_ : 0; }

    /// Records peaks[point page][mpm::PointPeak] at each measurement.
    void note(const double* peaks) { watch_.note(peaks); }

    /// Whether a sleep check is due when nothing is faster than `speed` (m/s). With damping none sleeps.
    bool is_due(double speed, double damping) const;

    /// Memory and tables of the sand whose points sleep and wake.
    struct Sand
    {
        mpm::Points<Exec, Real>&             points; ///< awake ones
        const mpm::GridGeometry&             geometry;
        const mpm::MaterialParameters<Real>* materials; ///< indexed by PointsView::material
        mpm::OrderScratch<Exec, Real>&       scratch;
    };

    /// Chooses the pages of all ranks that sleep from now on, keys ascending. `bodies` of this rank keep sand awake.
    /// With damping none sleeps. Collective.
    std::vector<std::uint64_t> choose(const mpm::Pages<Exec>& pages, const std::vector<BodyReach>& bodies,
                                      double damping);

    /// Moves the points of these pages, listed when they were chosen, to sleep and wakes others; empty if no page did.
    /// Otherwise all points must be sorted again; those that woke are then the last ones. Collective.
    std::optional<SleepMoves> sleep_on(const Sand& sand, const std::vector<std::uint64_t>& chosen);

    /// Wakes the pages near these bodies of this rank between two checks; result as of sleep_on(). Collective.
    std::optional<SleepMoves> wake_near(const Sand& sand, const std::vector<BodyReach>& bodies);

    /// Moves all points to the awake ones, as if pages had never slept.
    void wake_all(mpm::Points<Exec, Real>& awake);

    /// Tells all ranks what each has seen of its pages, before pages get other owners. Collective.
    void tell_ranks();

    /// Call before pages are rebuilt, and after.
    void leave_pages() { watch_.collect(held_); }
    void enter_pages(const mpm::Pages<Exec>& pages, const mpm::PagesView& view, SortScratch<Exec>& scratch);

    /// Holds the nodes of sleeping pages; the last operation on the grid in a step.
    void hold(const mpm::PagesView& pages, const mpm::SharedPagesView<Real>& shared, const Real* tiles,
              const mpm::GridStep<Real>& step, Real* motion, double* tallies);

    /// N s, impulse that stopped the points that fell asleep since the last call.
    Vec3<double> take_impulse();

    /// Saves or loads the state; pages must be those last entered. Points are saved separately. Collective.
    void transfer(StateFile& file, const mpm::Pages<Exec>& pages, const mpm::PagesView& view,
                  SortScratch<Exec>& scratch);

    /// The part of transfer() that does not depend on the distribution of points.
    void transfer_means(StateFile& file);

    /// Sets the magnitude of gravity (m/s2), to which the load at which a page wakes is proportional.
    void set_gravity(double gravity) { load_limit_ = load_mass_ * gravity; }

private:
    SleepMoves sleep_on(const Sand& sand, std::vector<std::uint64_t> chosen, const std::vector<std::uint64_t>& falling);
    std::int64_t move(mpm::Points<Exec, Real>& from, mpm::Points<Exec, Real>& to,
                      const std::vector<std::uint64_t>& pages_to_move, const Sand& sand, SandCensus& moved);
    void         count_points();
    SandCensus   census_of_leaving(mpm::Points<Exec, Real>& points, const mpm::MaterialParameters<Real>* materials);
    void         append(const Array<Exec, std::uint32_t>& rows, std::int64_t count, mpm::Points<Exec, Real>& to);
    void         stop(std::int64_t first);

    Exec                       exec_;
    const Communicator*        communicator_; ///< null on one rank
    RestRule                   rule_;
    double                     load_mass_;      ///< kg, whose weight on a page wakes it
    double                     load_limit_ = 0; ///< N a page
    mpm::Points<Exec, Real>    points_;
    std::int64_t               count_ = 0; ///< sleeping points of all ranks
    std::vector<std::uint64_t> asleep_;    ///< keys of pages of all ranks, ascending
    Array<Exec, std::uint64_t> asleep_key_;
    mpm::HeldPages<Exec>       held_;
    mpm::Leaving<Exec>         leaving_;
    PageWatch<Exec>            watch_;
    SandCensus                 census_;
    Vec3<double>               impulse_ = Vec3<double>::Zero();
    double                     slept_   = 0; ///< s, summed over points
    double                     lived_   = 0; ///< s
};

} // namespace tread::solver
