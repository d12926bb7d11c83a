#include "solver/mpm_solver.hpp"

#include <algorithm>
#include <numeric>

#include "backend/instantiate.hpp"
#include "world/materials.hpp"

namespace tread::solver
{
namespace
{

/// Nodes below this mass are held. The share of the lightest point's mass only keeps products of weights clear of
/// underflow in fp32: a larger one would hold nodes that move with the sand, and strain sand in free fall.
constexpr double mass_floor_share = 1e-20;

/// Relistings after which points are sorted in memory: scattered points of a cell cost memory reads.
constexpr int relists_an_order = 32;

/// Size for a census, or for a report.
constexpr std::int64_t totals_size = std::int64_t{mpm::census_count} + std::int64_t{std::tuple_size_v<ReportTotals>};

template<class Real>
std::vector<Real> cast(const std::vector<double>& values)
{
    return {values.begin(), values.end()};
}

/// Converts a vector per point to planes, one component after the other.
template<class Real, int components>
std::vector<Real> planes(const std::vector<Eigen::Matrix<double, components, 1>>& values)
{
    const std::size_t n = values.size();
    std::vector<Real> out(components * n);
    for (std::size_t i = 0; i < n; ++i)
    {
        for (std::size_t c = 0; c < components; ++c)
        {
            out[c * n + i] = static_cast<Real>(values[i][static_cast<Eigen::Index>(c)]);
        }
    }
    return out;
}

std::vector<std::uint32_t> numbers(const world::HostPoints& points)
{
    if (!points.id.empty()) { return points.id; }
    std::vector<std::uint32_t> ids(points.size());
    std::iota(ids.begin(), ids.end(), 0U);
    return ids;
}

/// Selects the points of the pages that a rank owns.
template<class Exec>
world::HostPoints own_points(const world::World& world, const decomp::Decomposition<Exec>& decomposition)
{
    world::HostPoints         own = world.points;
    std::vector<std::uint8_t> kept;
    own.id = numbers(own);
    for (const Vec3<double>& at : own.position)
    {
        const mpm::Index3 cell = mpm::cell_of(at, world.geometry.lattice());
        kept.push_back(decomposition.owners.owner(mpm::page_key(mpm::page_of(cell))) == decomposition.rank());
    }
    world::keep_points(own, kept);
    return own;
}

} // namespace

template<class Exec, class Real>
MpmSolver<Exec, Real>::MpmSolver(const Exec& exec, const scene::Scene& scene, const world::World& world,
                                 mpm::PointFields fields, decomp::Decomposition<Exec>* decomposition)
    : exec_(exec)
    , geometry_(world.geometry)
    , walls_(world.grid_walls)
    , gravity_(Vec3<double>(scene.domain.gravity[0], scene.domain.gravity[1], scene.domain.gravity[2]).cast<Real>())
    , mass_floor_(
          static_cast<Real>(mass_floor_share * *std::min_element(world.points.mass.begin(), world.points.mass.end())))
    , points_(exec)
    , pages_(exec)
    , order_scratch_(exec)
    , relist_scratch_(exec)
    , moves_to_(exec, "point moves")
    , move_counts_(exec, "page moves")
    , changed_in_(exec, "last step with moves", 1)
    , wall_pages_(exec)
    , tiles_(exec, "tiles")
    , motion_(exec, "grid motion")
    , grid_rows_(exec, "grid sums")
    , point_rows_(exec, "point sums")
    , peak_rows_(exec, "point peaks")
    , census_rows_(exec, "point census")
    , totals_(exec, "sand totals", totals_size)
    , sums_scratch_(exec, "sand sums scratch")
    , readback_(exec, "sand sums on the host")
    , materials_(exec, "materials")
    , pic_rate_(world::pic_rate(scene, world.points))
    , cell_means_(scene.numerics.volume_strain == scene::VolumeStrain::cell_average)
    , cell_divergence_(exec, "cell divergence")
    , shared_stress_(exec, "point stress of cell pressure")
{
    materials_.assign(world::law_parameters<Real>(scene));
    changed_in_.fill_zero();
    if (decomposition != nullptr) { ranks_.emplace(*decomposition); }
    if (scene.sleep.distance) { sleep_.emplace(exec, scene, world, fields); }
    if (geometry_.refinement.levels > 0) { seams_.emplace(exec); }
    const bool only_own = decomposition == nullptr || !world.points.id.empty();
    if (only_own) { upload(world.points, fields); }
    else { upload(own_points(world, *decomposition), fields); }
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::upload(const world::HostPoints& host, mpm::PointFields fields)
{
    const auto n = host.size();
    points_.allocate(static_cast<std::int64_t>(n), fields);
    if (n == 0) { return; }
    points_.position.assign(planes<double, 3>(host.position));
    points_.start.assign(planes<double, 3>(host.position));
    points_.stress.assign(planes<Real, 6>(host.stress));
    points_.mass.assign(cast<Real>(host.mass));
    points_.volume.assign(cast<Real>(host.volume));
    points_.volume_ratio.assign(std::vector<Real>(n, Real(1)));
    points_.material.assign(host.material);
    if (!host.velocity.empty()) { points_.velocity.assign(planes<Real, 3>(host.velocity)); }
    if (!host.velocity.empty() && fields.coupled) { points_.grid_velocity.assign(planes<Real, 3>(host.velocity)); }
    if (!host.plastic_shear.empty() && fields.plastic) { points_.plastic_shear.assign(cast<Real>(host.plastic_shear)); }
    points_.id.assign(numbers(host));
}

template<class Exec, class Real>
mpm::PagesView MpmSolver<Exec, Real>::pages() const
{
    return pages_.view(geometry_.lattice(), geometry_.refinement.levels);
}

/// Calls launch(pages, list) with the lattice and the point pages of each level of the grid.
template<class Exec, class Real>
template<class Launch>
void MpmSolver<Exec, Real>::for_each_level(const Launch& launch)
{
    if (!seams_)
    {
        launch(pages(), mpm::all_point_pages(pages()));
        return;
    }
    for (int level = 0; level <= geometry_.refinement.levels; ++level)
    {
        launch(mpm::on_level(pages(), geometry_.refinement, level), seams_->point_pages(level));
    }
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::order()
{
    if (listed_) { return; } // migration since then is still to be reported
    migrated_ = 0;
    listed_   = true;
    if (steps_ > 0)
    {
        list_anew();
        return;
    }
    if (cell_change_ == mpm::CellChange::none) { return; }
    if (cell_change_ != mpm::CellChange::moved)
    {
        order_in_memory();
        return;
    }
    list_anew();
    if (relists_ < relists_an_order) { return; }
    mpm::renew_order(exec_, points_, pages_, order_scratch_);
    relists_ = 0;
    ++reorder_count_;
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::update_sleeping_pages(const std::vector<BodyReach>& bodies, double damping)
{
    if (sleep_->look(points_, pages_, geometry_, bodies, materials_.data(), order_scratch_, damping))
    {
        order_in_memory();
    }
}

template<class Exec, class Real>
std::optional<double> MpmSolver<Exec, Real>::mean_asleep() const
{
    if (!sleep_) { return {}; }
    return count() > 0 ? sleep_->mean_count() / static_cast<double>(count()) : 0;
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::follow_owners()
{
    listed_      = false;
    cell_change_ = mpm::CellChange::lost;
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::add_loads(decomp::PageLoads& loads) const
{
    const std::vector<std::uint64_t> page  = pages_.point_page_key.to_host();
    const std::vector<std::int32_t>  first = pages_.first_point.to_host();
    for (std::size_t i = 0; i < page.size(); ++i)
    {
        if (first[i + 1] > first[i]) { loads[page[i]] += first[i + 1] - first[i]; }
    }
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::list_anew()
{
    mpm::relist_points(exec_, pages_, moves(), relist_scratch_, order_scratch_.keys);
    ++relists_;
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::order_in_memory()
{
    if (sleep_) { sleep_->leave_pages(); }
    std::int64_t left = 0;
    if (ranks_)
    {
        left      = ranks_->order(points_, pages_, geometry_, walls_, order_scratch_);
        migrated_ = ranks_->moved();
    }
    else { left = mpm::order_points(exec_, points_, pages_, geometry_, order_scratch_); }
    keep_account_of(left);
    relists_ = 0;
    ++reorder_count_;
    make_room();
    if (sleep_) { sleep_->enter_pages(pages_, pages(), order_scratch_.sort); }
}

/// Allocates what steps write per point and page.
template<class Exec, class Real>
void MpmSolver<Exec, Real>::make_room()
{
    const std::int64_t point_pages = pages_.point_page_key.size(), node_pages = pages_.node_page_key.size();
    tiles_.resize(point_pages * mpm::node_channels * mpm::tile_nodes);
    motion_.resize(node_pages * mpm::motion_channels * mpm::page_cells);
    grid_rows_.resize(node_pages * mpm::tally_width(mpm::grid_sums));
    point_rows_.resize(point_pages * mpm::tally_width(mpm::point_sums));
    peak_rows_.resize(point_pages * mpm::point_peaks);
    clear_tallies();
    if (cell_means_)
    {
        cell_divergence_.resize(point_pages * mpm::page_cells);
        shared_stress_.resize(points_.stress.size());
    }
    if (seams_) { mpm::list_seams(exec_, pages(), geometry_.refinement, *seams_, order_scratch_.sort); }
    if (mpm::has_walls(walls_)) { mpm::list_wall_pages(exec_, pages(), walls_, wall_pages_, order_scratch_.sort); }
    moves_to_.resize(points_.count);
    move_counts_.resize(point_pages * mpm::move_counts);
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::clear_tallies()
{
    grid_rows_.fill_zero();
    point_rows_.fill_zero();
    peak_rows_.fill_zero();
}

template<class Exec, class Real>
mpm::MovesView MpmSolver<Exec, Real>::moves()
{
    return {moves_to_.data(), move_counts_.data(), changed_in_.data(), step_};
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::scatter()
{
    mpm::PointsView<Real> points = points_.view();
    if (cell_means_)
    {
        const Planes<Real, 6> shared{shared_stress_.data(), points_.stride};
        mpm::share_pressure(exec_, points, pages(), shared);
        points.stress = shared;
    }
    if (ranks_)
    {
        const auto scatter_pages = [&](const Exec& exec, const mpm::PageList& list)
        { mpm::scatter(exec, points, pages(), list, tiles_.data()); };
        ranks_->halo().begin(pages(), tiles_.data(), scatter_pages);
        scatter_pages(exec_, ranks_->halo().interior());
        return;
    }
    for_each_level([&](const mpm::PagesView& pages, const mpm::PageList& list)
                   { mpm::scatter(exec_, points, pages, list, tiles_.data()); });
    if (seams_) { mpm::hand_down(exec_, pages(), geometry_.refinement, tiles_.data(), *seams_); }
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::update_grid(double dt, double damping)
{
    const mpm::GridStep<Real> step{static_cast<Real>(dt), gravity_, static_cast<Real>(damping), mass_floor_, walls_};
    const mpm::SharedPagesView<Real> shared = ranks_   ? ranks_->halo().view()
                                              : seams_ ? seams_->view()
                                                       : mpm::SharedPagesView<Real>{};
    mpm::update_grid(exec_, pages(), wall_pages_.view(), shared, tiles_.data(), step, motion_.data(),
                     grid_rows_.data());
    mpm::update_walls(exec_, pages(), wall_pages_.view(), step, motion_.data(), grid_rows_.data());
    if (sleep_) { sleep_->hold(pages(), tiles_.data(), step, motion_.data(), grid_rows_.data()); }
    if (seams_) { mpm::follow_coarser(exec_, pages(), geometry_.refinement, *seams_, motion_.data()); }
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::gather(double dt)
{
    ++step_;
    if (cell_means_)
    {
        for_each_level(
            [&](const mpm::PagesView& pages, const mpm::PageList& list)
            {
                mpm::average_divergence(exec_, points_.view(), pages, list, motion_.data(), static_cast<Real>(dt),
                                        cell_divergence_.data());
            });
    }
    const mpm::GatherStep<Real> step{static_cast<Real>(dt), materials_.data(),
                                     static_cast<Real>(world::pic_share(pic_rate_, dt)), cell_divergence_.data()};
    for_each_level(
        [&](const mpm::PagesView& pages, const mpm::PageList& list)
        {
            mpm::gather(exec_, points_.view(), pages, list, motion_.data(), step, moves(), point_rows_.data(),
                        peak_rows_.data());
        });
    if (sleep_) { sleep_->pass(dt); }
    listed_ = false;
    ++steps_;
}

#define TREAD_INSTANTIATE(Exec, Real) template class MpmSolver<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
