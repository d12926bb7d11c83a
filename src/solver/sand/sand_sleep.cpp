#include "solver/sand/sand_sleep.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string_view>
#include <utility>

#include "backend/instantiate.hpp"
#include "backend/reduce.hpp"
#include "decomp/point_columns.hpp"
#include "kernels/mpm/pages/census.hpp"
#include "solver/ranks/over_ranks.hpp"
#include "solver/ranks/rest_of_ranks.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

/// Share of the rule's distance that anything may move without a sleep check.
constexpr double unseen_share = 0.25;

/// Number of points per partial sum of a census.
constexpr std::int64_t census_run = 512;

/// Mass of the bed over the area of the domain's floor, kg/m2.
double mass_on_floor(const scene::Scene& scene, const world::World& world)
{
    return world::total_mass(world.sand) / (scene.domain.size[0] * scene.domain.size[1]);
}

std::vector<std::uint64_t> without(const std::vector<std::uint64_t>& all, const std::vector<std::uint64_t>& these)
{
    std::vector<std::uint64_t> rest;
    std::set_difference(all.begin(), all.end(), these.begin(), these.end(), std::back_inserter(rest));
    return rest;
}

/// Whether a field is zero for a point at rest.
bool is_motion(std::string_view field)
{
    constexpr std::string_view names[] = {"velocity", "affine", "plastic_rate", "grid_velocity"};
    return std::find(std::begin(names), std::end(names), field) != std::end(names);
}

} // namespace

template<class Exec, class Real>
SandSleep<Exec, Real>::SandSleep(const Exec& exec, const scene::Scene& scene, const world::World& world,
                                 mpm::PointFields fields, const Communicator* communicator)
    : exec_(exec)
    , communicator_(communicator)
    , rule_{mpm::page_edge * world.geometry.spacing, scene.sleep.distance.value(), scene.sleep.speed, scene.sleep.rest}
    , load_mass_(scene.sleep.load * mass_on_floor(scene, world) * rule_.page_edge * rule_.page_edge)
    , points_(exec)
    , asleep_key_(exec, "sleeping pages")
    , held_(exec)
    , leaving_(exec)
    , watch_(exec)
{
    points_.allocate(0, fields);
    set_gravity(Vec3<double>(scene.domain.gravity.data()).norm());
}

template<class Exec, class Real>
void SandSleep<Exec, Real>::pass(double dt)
{
    watch_.pass(dt);
    slept_ += dt * static_cast<double>(count_);
    lived_ += dt;
}

template<class Exec, class Real>
bool SandSleep<Exec, Real>::is_due(double speed, double damping) const
{
    if (damping > 0) { return !asleep_.empty(); }
    return watch_.window() >= rule_.rest || watch_.window() * speed >= unseen_share * rule_.distance;
}

template<class Exec, class Real>
std::vector<std::uint64_t> SandSleep<Exec, Real>::choose(const mpm::Pages<Exec>&       pages,
                                                         const std::vector<BodyReach>& bodies, double damping)
{
    watch_.collect(held_);
    RestState state{watch_.awake(pages, rule_.speed), asleep_, watch_.pressed(load_limit_), bodies};
    gather_rest(communicator_, state);
    watch_.remember(state.awake);
    watch_.begin_window();
    return damping == 0 ? choose_asleep(rule_, state) : std::vector<std::uint64_t>{};
}

template<class Exec, class Real>
std::optional<SleepMoves> SandSleep<Exec, Real>::sleep_on(const Sand& sand, const std::vector<std::uint64_t>& chosen)
{
    if (chosen == asleep_) { return {}; }
    return sleep_on(sand, chosen, chosen);
}

template<class Exec, class Real>
std::optional<SleepMoves> SandSleep<Exec, Real>::wake_near(const Sand& sand, const std::vector<BodyReach>& bodies)
{
    if (asleep_.empty()) { return {}; }
    std::vector<std::uint64_t> chosen = stay_asleep(rule_, asleep_, bodies_of_ranks(communicator_, bodies));
    if (chosen == asleep_) { return {}; }
    watch_.note_woken(without(asleep_, chosen));
    return sleep_on(sand, std::move(chosen), {});
}

/// Has the chosen pages sleep from now on, and no others. `falling`: those whose awake points fall asleep; points may
/// have entered a page since it did.
template<class Exec, class Real>
SleepMoves SandSleep<Exec, Real>::sleep_on(const Sand& sand, std::vector<std::uint64_t> chosen,
                                           const std::vector<std::uint64_t>& falling)
{
    SandCensus woken, fallen;
    SleepMoves moves;
    moves.woken               = move(points_, sand.points, without(asleep_, chosen), sand, woken);
    const std::int64_t before = points_.count;
    moves.fallen              = move(sand.points, points_, falling, sand, fallen);
    stop(before);
    sum_over_ranks(communicator_, woken);
    sum_over_ranks(communicator_, fallen);
    impulse_ -= fallen.momentum;
    fallen.kinetic  = 0;
    fallen.momentum = Vec3<double>::Zero();
    census_         = census_ - woken + fallen;
    count_points();
    if (count_ == 0) { census_ = {}; }
    asleep_ = std::move(chosen);
    asleep_key_.assign(asleep_);
    return moves;
}

template<class Exec, class Real>
void SandSleep<Exec, Real>::count_points()
{
    count_ = communicator_ == nullptr ? points_.count : communicator_->sum(points_.count);
}

/// Moves the points of whole pages; returns their number. `moved`: census of these points.
template<class Exec, class Real>
std::int64_t SandSleep<Exec, Real>::move(mpm::Points<Exec, Real>& from, mpm::Points<Exec, Real>& to,
                                         const std::vector<std::uint64_t>& pages_to_move, const Sand& sand,
                                         SandCensus& moved)
{
    if (pages_to_move.empty()) { return 0; }
    constexpr std::int32_t     nobody = -1, other = 0;
    Array<Exec, std::uint64_t> key(exec_, "pages that wake or fall asleep");
    Array<Exec, std::int32_t>  owner(exec_, "owners of pages that wake or fall asleep");
    key.assign(pages_to_move);
    owner.assign(std::vector<std::int32_t>(pages_to_move.size(), other));
    mpm::find_leaving(exec_, from, sand.geometry, {key.size(), key.data(), owner.data()}, nobody, leaving_,
                      sand.scratch);
    const std::int64_t count = leaving_.row.size();
    if (count == 0) { return 0; }
    moved = census_of_leaving(from, sand.materials);

    const decomp::Columns      columns = decomp::point_columns(from);
    Array<Exec, std::uint32_t> rows(exec_, "points that wake or fall asleep", count * columns.words);
    decomp::pack_rows(exec_, columns, leaving_.row.data(), count, rows.data());
    mpm::remove_leaving(exec_, from, leaving_, sand.scratch);
    append(rows, count, to);
    return count;
}

/// Appends rows of decomp::pack_rows.
template<class Exec, class Real>
void SandSleep<Exec, Real>::append(const Array<Exec, std::uint32_t>& rows, std::int64_t count,
                                   mpm::Points<Exec, Real>& to)
{
    to.reserve(to.count + count);
    decomp::unpack_rows(exec_, rows.data(), count, decomp::point_columns(to), nullptr, to.count);
    to.count += count;
}

template<class Exec, class Real>
void SandSleep<Exec, Real>::wake_all(mpm::Points<Exec, Real>& awake)
{
    const std::int64_t        count = points_.count;
    std::vector<std::int32_t> all(static_cast<std::size_t>(count));
    std::iota(all.begin(), all.end(), 0);
    Array<Exec, std::int32_t> row(exec_, "all sleeping points");
    row.assign(all);
    const decomp::Columns      columns = decomp::point_columns(points_);
    Array<Exec, std::uint32_t> rows(exec_, "points that wake", count * columns.words);
    decomp::pack_rows(exec_, columns, row.data(), count, rows.data());
    append(rows, count, awake);
    points_.count = 0;
}

template<class Exec, class Real>
void SandSleep<Exec, Real>::tell_ranks()
{
    watch_.collect(held_);
    watch_.tell_ranks(*communicator_);
}

template<class Exec, class Real>
SandCensus SandSleep<Exec, Real>::census_of_leaving(mpm::Points<Exec, Real>&             points,
                                                    const mpm::MaterialParameters<Real>* materials)
{
    const std::int64_t        count = leaving_.row.size();
    std::vector<std::int32_t> first;
    for (std::int64_t at = 0; at < count; at += census_run) { first.push_back(static_cast<std::int32_t>(at)); }
    const auto runs = static_cast<std::int64_t>(first.size());
    first.push_back(static_cast<std::int32_t>(count));
    Array<Exec, std::int32_t> first_point(exec_, "runs of moved points");
    Array<Exec, double>       rows(exec_, "census of moved points", runs * mpm::census_count);
    Array<Exec, double>       total(exec_, "census of moved points, total", mpm::census_count);
    first_point.assign(first);
    mpm::PagesView as_pages{};
    as_pages.point_pages = runs;
    as_pages.first_point = first_point.data();
    as_pages.point_at    = leaving_.row.data();
    mpm::take_census(exec_, points.view(), as_pages, materials, rows.data());
    sum_rows(exec_, rows.data(), runs, mpm::census_count, total.data());
    return census_of(total.to_host().data());
}

/// Stops the points from `first` on, which have just fallen asleep.
template<class Exec, class Real>
void SandSleep<Exec, Real>::stop(std::int64_t first)
{
    points_.for_each_named_field(
        [&](const char* name, auto& field, int components)
        {
            if (!is_motion(name)) { return; }
            const auto bytes = static_cast<std::size_t>(points_.count - first) * sizeof(*field.data());
            for (int c = 0; c < components; ++c) { fill_zero(exec_, field.data() + c * points_.stride + first, bytes); }
        });
}

template<class Exec, class Real>
void SandSleep<Exec, Real>::enter_pages(const mpm::Pages<Exec>& pages, const mpm::PagesView& view,
                                        SortScratch<Exec>& scratch)
{
    mpm::list_held_pages(exec_, view, asleep_key_, held_, scratch);
    watch_.follow(pages, held_);
}

template<class Exec, class Real>
void SandSleep<Exec, Real>::hold(const mpm::PagesView& pages, const mpm::SharedPagesView<Real>& shared,
                                 const Real* tiles, const mpm::GridStep<Real>& step, Real* motion, double* tallies)
{
    mpm::hold_still(exec_, pages, held_.view(), shared, tiles, step, motion, tallies);
}

template<class Exec, class Real>
Vec3<double> SandSleep<Exec, Real>::take_impulse()
{
    return std::exchange(impulse_, Vec3<double>::Zero());
}

template<class Exec, class Real>
void SandSleep<Exec, Real>::transfer(StateFile& file, const mpm::Pages<Exec>& pages, const mpm::PagesView& view,
                                     SortScratch<Exec>& scratch)
{
    file.common("sleep/asleep", asleep_, accept::all(accept::ascending(), accept::distinct()));
    solver::transfer(file, "sleep/census", census_);
    file.doubles("sleep/stopped", impulse_);
    transfer_means(file);
    if (file.loads())
    {
        count_points();
        asleep_key_.assign(asleep_);
        enter_pages(pages, view, scratch);
    }
    watch_.transfer(file, held_);
}

template<class Exec, class Real>
void SandSleep<Exec, Real>::transfer_means(StateFile& file)
{
    file.numbers("sleep/time", slept_, lived_);
}

#define TREAD_INSTANTIATE(Exec, Real) template class SandSleep<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
