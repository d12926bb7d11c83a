#include "solver/sand/mpm_solver.hpp"

#include "backend/instantiate.hpp"
#include "kernels/mpm/transfers/cell_divergence.hpp"
#include "solver/sand/page_bounds.hpp"
#include "solver/sand/point_places.hpp"
#include "solver/sand/point_state.hpp"
#include "solver/sand/point_upload.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

/// Load of a sleeping page, in points: it needs an owner, and costs no time.
constexpr double load_asleep = 1;

/// Near its pages where there are bodies that sand may touch.
Outside outside_of(const world::World& world)
{
    return world.bodies.size() > 0 ? Outside::near_pages : Outside::anywhere;
}

} // namespace

template<class Exec, class Real>
MpmSolver<Exec, Real>::MpmSolver(const Exec& exec, const scene::Scene& scene, const world::World& world,
                                 mpm::PointFields fields, decomp::Decomposition<Exec>* decomposition)
    : exec_(exec)
    , points_(exec)
    , order_(exec)
    , grid_(exec, scene, world)
    , laws_(exec, scene, world)
    , tallies_(exec)
{
    if (decomposition != nullptr) { ranks_.emplace(*decomposition, outside_of(world)); }
    if (scene.sleep.distance) { sleep_.emplace(exec, scene, world, fields, communicator()); }
    if (decomposition == nullptr) { upload_points(points_, world::make_points(scene, world, world.sand.rows), fields); }
    else { upload_points(points_, own_points(scene, world, *decomposition), fields); }
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::order()
{
    if (order_.listed) { return; } // migration since then is still to be reported
    order_.migrated = 0;
    order_.listed   = true;
    switch (order_due(order_, tallies_.steps))
    {
    case OrderDue::nothing:
        return;
    case OrderDue::relist:
        relist(exec_, order_);
        return;
    case OrderDue::renew:
        relist(exec_, order_);
        renew_if_scattered(exec_, order_, points_);
        return;
    case OrderDue::sort:
        order_in_memory();
        return;
    }
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::order_in_memory()
{
    if (sleep_) { sleep_->leave_pages(); }
    std::int64_t left = 0;
    if (ranks_)
    {
        left            = ranks_->order(points_, order_.pages, grid_.geometry, grid_.walls, order_.scratch);
        order_.migrated = ranks_->moved();
    }
    else { left = mpm::order_points(exec_, points_, order_.pages, grid_.geometry, order_.scratch); }
    account_for_left(exec_, tallies_, points_, left, pages(), laws_.materials.data(), communicator());
    order_.relists = 0;
    ++order_.reorder_count;
    make_room();
    if (sleep_) { sleep_->enter_pages(order_.pages, pages(), order_.scratch.sort); }
}

/// Allocates what steps write per point and page.
template<class Exec, class Real>
void MpmSolver<Exec, Real>::make_room()
{
    follow_pages(exec_, grid_, pages(), order_.scratch.sort);
    resize_tallies(tallies_, order_.pages);
    resize_cell_means(laws_, points_, order_.pages);
    resize_moves(order_, points_.count);
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::update_sleeping_pages(const std::vector<BodyReach>& bodies, double damping,
                                                  const SleepFollower& follow)
{
    const std::vector<std::uint64_t> chosen = sleep_->choose(order_.pages, bodies, damping);
    if (follow.choose)
    {
        Array<Exec, std::uint64_t> asleep(exec_, "pages that sleep");
        asleep.assign(chosen);
        const mpm::PagesView all = pages();
        follow.choose({{all.spacing, all.stencil_shift},
                       {all.point_pages, all.point_page_key},
                       all.first_point,
                       {asleep.size(), asleep.data()}});
    }
    follow_moves(sleep_->sleep_on(sleeping_sand(), chosen), follow);
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::wake_near(const std::vector<BodyReach>& bodies, const SleepFollower& follow)
{
    follow_moves(sleep_->wake_near(sleeping_sand(), bodies), follow);
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::follow_moves(const std::optional<SleepMoves>& moves, const SleepFollower& follow)
{
    if (!moves) { return; }
    if (follow.move)
    {
        const mpm::PointsView<Real> asleep = sleep_->points().view(), awake = points_.view();
        follow.move({asleep, asleep.count - moves->fallen, awake, awake.count - moves->woken});
    }
    order_in_memory();
}

template<class Exec, class Real>
std::optional<double> MpmSolver<Exec, Real>::mean_asleep() const
{
    if (!sleep_) { return {}; }
    const std::int64_t all = communicator() == nullptr ? count() : communicator()->sum(count());
    return all > 0 ? sleep_->mean_count() / static_cast<double>(all) : 0;
}

template<class Exec, class Real>
std::int64_t MpmSolver<Exec, Real>::follow_owners()
{
    std::int64_t moved = 0;
    if (sleep_)
    {
        sleep_->tell_ranks();
        moved = ranks_->migrate(sleep_->points(), grid_.geometry, order_.scratch);
    }
    order_.listed      = false;
    order_.cell_change = mpm::CellChange::lost;
    return moved;
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::add_loads(decomp::PageLoads& loads) const
{
    const std::vector<std::uint64_t> page  = order_.pages.point_page_key.to_host();
    const std::vector<std::int32_t>  first = order_.pages.first_point.to_host();
    for (std::size_t i = 0; i < page.size(); ++i)
    {
        if (first[i + 1] > first[i]) { loads[page[i]] += first[i + 1] - first[i]; }
    }
    if (!sleep_) { return; }
    for (const std::uint64_t key : sleep_->pages())
    {
        if (ranks_->owns(key)) { loads[key] += load_asleep; }
    }
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::scatter()
{
    const mpm::PointsView<Real> points = points_of_scatter(exec_, laws_, points_, pages());
    if (ranks_) { points_to_shared_grid(exec_, grid_, points, pages(), ranks_->halo()); }
    else { points_to_grid(exec_, grid_, points, pages()); }
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::update_grid(double dt, double damping)
{
    const mpm::GridStep<Real>        step   = grid_step(grid_, dt, damping);
    const mpm::SharedPagesView<Real> shared = ranks_ ? ranks_->halo().view() : mpm::SharedPagesView<Real>{};
    double*                          rows   = tallies_.grid_rows.data();
    update_nodes(exec_, grid_, pages(), shared, step, rows);
    if (sleep_) { sleep_->hold(pages(), shared, grid_.tiles.data(), step, grid_.motion.data(), rows); }
    if (grid_.seams)
    {
        mpm::follow_coarser(exec_, pages(), grid_.geometry.refinement, *grid_.seams, grid_.motion.data());
    }
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::gather(double dt)
{
    ++order_.step;
    if (laws_.mean_strain && order_.step % laws_.mean_strain->smoothing.interval == 0)
    {
        mpm::average_strain(exec_, points_.view(), pages(), laws_.materials.data(), *laws_.mean_strain);
    }
    if (laws_.cell_means)
    {
        for_each_level(grid_, pages(),
                       [&](const mpm::PagesView& pages, const mpm::PageList& list)
                       {
                           mpm::average_divergence(exec_, points_.view(), pages, list, grid_.motion.data(),
                                                   static_cast<Real>(dt), laws_.cell_means->divergence.data());
                       });
    }
    const mpm::GatherStep<Real> step = gather_step(laws_, dt);
    for_each_level(grid_, pages(),
                   [&](const mpm::PagesView& pages, const mpm::PageList& list)
                   {
                       mpm::gather(exec_, points_.view(), pages, list, grid_.motion.data(), step, order_.moves(),
                                   tallies_.point_rows.data(), tallies_.peak_rows.data());
                   });
    if (sleep_) { sleep_->pass(dt); }
    order_.listed = false;
    ++tallies_.steps;
}

template<class Exec, class Real>
SandReport MpmSolver<Exec, Real>::report()
{
    if (!tallies_.requested) { request_report(); }
    SandReport report  = take_report(exec_, tallies_, communicator());
    order_.cell_change = report.cell_change();
    if (sleep_)
    {
        report.last_points[mpm::point_strain] += sleep_->census().strain;
        const Vec3<double> stopped = sleep_->take_impulse();
        for (int c = 0; c < 3; ++c) { report.grid[mpm::grid_wall_impulse + c] += stopped[c]; }
    }
    return report;
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::request_report()
{
    if (ranks_) { ranks_->halo().clear_tallied_elsewhere(mpm::tally_width(mpm::grid_sums), tallies_.grid_rows.data()); }
    request_totals(exec_, tallies_, order_.pages);
    if (sleep_) { sleep_->note(tallies_.peak_rows.data()); }
    clear_tallies(tallies_);
}

template<class Exec, class Real>
SandCensus MpmSolver<Exec, Real>::census()
{
    order();
    SandCensus census = take_census(exec_, tallies_, points_.view(), pages(), laws_.materials.data(), communicator());
    if (sleep_) { census = census + sleep_->census(); }
    tallies_.mass = census.mass;
    return census + census_of(tallies_.left.data());
}

template<class Exec, class Real>
std::vector<const mpm::Points<Exec, Real>*> MpmSolver<Exec, Real>::all_points() const
{
    if (!sleep_) { return {&points_}; }
    return {&points_, &sleep_->points()};
}

template<class Exec, class Real>
std::vector<Vec3<double>> MpmSolver<Exec, Real>::positions() const
{
    std::vector<Vec3<double>> positions;
    for (const mpm::Points<Exec, Real>* points : all_points()) { append_positions(*points, positions); }
    return positions;
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::add_to(world::TerrainBins& bins) const
{
    for (const mpm::Points<Exec, Real>* points : all_points()) { add_cubes(*points, bins); }
}

/// Listed points need no other data of the last step.
template<class Exec, class Real>
void MpmSolver<Exec, Real>::transfer(StateFile& file, const world::Sand& built)
{
    if (!file.loads()) { order(); }
    std::vector<bool> seen(built.size(), false);
    transfer_points(file, points_, "points", grid_.geometry, built, seen);
    file.numbers("sand/steps", order_.step, order_.relists, order_.reorder_count, tallies_.mass);
    file.doubles("sand/left", tallies_.left);
    if (file.exact()) { transfer_lists(file, built, seen); }
    if (!file.loads()) { return; }
    if (!file.exact())
    {
        if (sleep_)
        {
            transfer_points(file, sleep_->points(), "asleep", grid_.geometry, built, seen);
            sleep_->transfer_means(file);
            sleep_->wake_all(points_);
        }
        order_in_memory();
        order_.migrated = 0; // no per-point data waits to be migrated
    }
    order_.listed  = true;
    tallies_.steps = 0;
}

/// Transfers the additional data of an exact state. `seen`: ids.
template<class Exec, class Real>
void MpmSolver<Exec, Real>::transfer_lists(StateFile& file, const world::Sand& built, std::vector<bool>& seen)
{
    PageBounds bounds(points_.count);
    order_.pages.for_each_field(
        [&](const std::string& name, auto& array)
        { file.own("pages/" + name, array, [&](const auto& values) { return bounds(name, values); }); });
    if (file.loads())
    {
        if (ranks_) { ranks_->resume(order_.pages, grid_.walls); }
        make_room();
        order_.changed_in.fill_zero();
    }
    if (!sleep_) { return; }
    transfer_points(file, sleep_->points(), "asleep", grid_.geometry, built, seen);
    sleep_->transfer(file, order_.pages, pages(), order_.scratch.sort);
}

#define TREAD_INSTANTIATE(Exec, Real) template class MpmSolver<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
