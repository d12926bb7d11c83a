#include "solver/bodies/body_state.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "kernels/mpm/pages/far_cells.hpp"
#include "scene/phase_settings.hpp"
#include "solver/bodies/bounding_radii.hpp"
#include "solver/bodies/row_transfer.hpp"
#include "solver/state_file.hpp"
#include "world/cover.hpp"

namespace tread::solver
{
namespace
{

constexpr double freedoms = dem::all_flags; ///< all bits of BodiesView::locked
constexpr double furthest = 1e6;            ///< m, largest accepted distance of a body from the domain's corner
constexpr double fastest  = 1e6;            ///< m/s and rad/s: steps with faster bodies would not end
constexpr double shortest = 1e-10;          ///< s, smallest accepted sqrt(m / K) of a body with contacts of stiffness K

/// m, largest distance of a body from the pages of a rank whose sand can touch it.
double sand_reach(const scene::Scene& scene, const world::World& world)
{
    return mpm::farthest_outside * scene.grid.spacing + world::make_point_reach(scene, world.sand).farthest(world.sand);
}

void require_distinct_keys(const world::World& world)
{
    const std::size_t sides = world.bodies.size() + world.planes.size();
    if (sides <= static_cast<std::size_t>(dem::most_bodies)) { return; }
    throw InputError(fmt::format("{} bodies and walls: at most {} can be told apart", sides, dem::most_bodies));
}

/// Copies the bodies that this rank has rows for to the backend, at their start, at rest and named ones locked.
template<class Exec>
void upload(BodyState<Exec>& state)
{
    const world::World&        world   = state.world;
    const world::HostBodies&   host    = world.bodies;
    const BodyNumbers&         numbers = state.numbers();
    dem::Bodies<Exec>&         bodies  = state.bodies;
    const auto                 named   = static_cast<std::size_t>(state.named());
    const std::size_t          rows    = numbers.rows();
    std::vector<Sym3<double>>  inertia;
    std::vector<std::uint32_t> locked(rows, 0);
    std::vector<std::int32_t>  damped(rows, 1);
    for (std::size_t row = 0; row < rows; ++row)
    {
        const auto  b    = static_cast<std::size_t>(numbers.number(static_cast<std::int64_t>(row)));
        const auto& unit = world.templates[static_cast<std::size_t>(host.shape[b])].unit;
        // At scale s a mass m has the inertia of density m / (s^3 V): m / V times s^2 times that of density 1.
        inertia.push_back(
            symmetric<double>(unit.inertia * (host.mass[b] / unit.volume * host.scale[b] * host.scale[b])));
        if (b < named)
        {
            locked[row] = dem::lock_all;
            damped[row] = 0;
        }
    }
    bodies.position.assign(numbers.of_rows(host.position));
    bodies.orientation.assign(numbers.of_rows(host.orientation));
    bodies.velocity.assign(std::vector<Vec3<double>>(rows, Vec3<double>::Zero()));
    bodies.angular_velocity.assign(std::vector<Vec3<double>>(rows, Vec3<double>::Zero()));
    bodies.mass.assign(numbers.of_rows(host.mass));
    bodies.inertia.assign(inertia);
    bodies.scale.assign(numbers.of_rows(host.scale));
    bodies.shape.assign(numbers.of_rows(host.shape));
    bodies.material.assign(numbers.of_rows(host.material));
    bodies.locked.assign(locked);
    bodies.weight.assign(std::vector<double>(named, 1.0));
    bodies.damped.assign(damped);
    const auto count = static_cast<std::int64_t>(rows);
    bodies.force.resize(count);
    bodies.torque.resize(count);
    bodies.stiffness.resize(count);
    bodies.force.fill_zero();
    bodies.torque.fill_zero();
    bodies.stiffness.fill_zero();
    if (state.scales_inertia) { state.inertia_factor.assign(std::vector<double>(rows, 1.0)); }
}

/// Writes all arrays by row for the bodies that this rank has rows for, at their start.
template<class Exec>
void write_rows(BodyState<Exec>& state)
{
    upload(state);
    const std::vector<double> radii = bounding_radii(state.world);
    state.tables.bounding_radii.assign(state.numbers().of_rows(radii));
    if (state.has_contact)
    {
        dem::classify_bodies(state.exec, state.pairs, state.view(), state.tables.law.templates,
                             dem::largest_in_grid(radii));
    }
    if (state.ranks) { state.ranks->write_rows(state.bodies); }
}

/// Keys of the pairs of bodies that a joint ties, ascending: their shapes may overlap, as those of a wheel and its
/// axle.
std::vector<std::uint64_t> jointed_pairs(const std::vector<dem::Joint>& joints)
{
    std::vector<std::uint64_t> keys;
    for (const dem::Joint& joint : joints)
    {
        const auto [a, b] = std::minmax(joint.body[0], joint.body[1]);
        if (joint.kind != dem::joint_spring && a != dem::joint_world) { keys.push_back(dem::pair_key(a, b)); }
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    return keys;
}

/// Accepts contact stiffnesses of bodies of these masses that do not require endless substeps.
auto accepted_stiffness(const std::vector<double>& mass)
{
    const auto most = [&mass](std::size_t b) { return mass[b] / (shortest * shortest); };
    return accept::each_at([most](std::size_t b, double value) { return 0 <= value && value <= most(b); },
                           [most](std::size_t b) { return fmt::format("0 to {}", most(b)); });
}

/// Accepts valid values of a body field. `present`: the scene's values, as sizes, shapes and materials must not change.
/// `mass`: of the scene's bodies.
template<class T>
auto accepted_field(std::string_view name, std::vector<T> present, const std::vector<double>& mass)
{
    return [name, &mass, present = std::move(present)](const std::vector<T>& values) -> accept::Verdict
    {
        if (auto refusal = accept::rows(present.size())(values)) { return refusal; }
        if constexpr (std::is_same_v<T, std::uint32_t>) { return accept::within(0, freedoms)(values); }
        else if constexpr (std::is_same_v<T, std::int32_t>)
        {
            return name == "damped" ? accept::within(0, 1)(values) : accept::same_as(present)(values);
        }
        else if constexpr (std::is_same_v<T, Quat>) { return accept::unit_quaternions()(values); }
        else if constexpr (std::is_same_v<T, double>)
        {
            if (name == "stiffness") { return accepted_stiffness(mass)(values); }
            return name == "weight" ? accept::finite()(values) : accept::same_as(present)(values);
        }
        else if (name == "inertia") { return accept::same_as(present)(values); }
        else if (name == "position") { return accept::within(-furthest, furthest)(values); }
        else if (name == "force" || name == "torque") { return accept::finite()(values); }
        else { return accept::within(-fastest, fastest)(values); }
    };
}

/// Accepts a field of all bodies whose rows of this rank `accepted` accepts.
template<class T, class Bound>
auto of_rows(const BodyNumbers& numbers, const Bound& accepted)
{
    return [&numbers, &accepted](const std::vector<T>& values) -> accept::Verdict
    {
        if (auto refusal = accept::rows(numbers.bodies())(values)) { return refusal; }
        accept::Verdict refusal = accepted(numbers.of_rows(values));
        if (refusal && refusal->row >= 0) { refusal->row = numbers.number(refusal->row); }
        return refusal;
    };
}

} // namespace

template<class Exec>
BodyState<Exec>::BodyState(const Exec& backend, const scene::Scene& of_scene, const world::World& of_world,
                           const Plan& plan, decomp::Decomposition<Exec>* decomposition)
    : exec(backend)
    , scene(of_scene)
    , world(of_world)
    , every(of_world.bodies.size())
    , gravity(of_scene.domain.gravity.data())
    , has_contact(plan.body_contact)
    , scales_inertia(plan.mass_scaling)
    , mass_scaling{of_world.bodies.named, scene::mass_scaling_in(of_scene, 0)}
    , tables(backend, of_scene, of_world, plan)
    , bodies(backend)
    , pairs(backend)
    , inertia_factor(backend, "inertia factors of bodies")
{
    require_distinct_keys(world);
    for (const double m : world.bodies.mass) { mass += m; }
    pairs.resists_rolling = tables.rolling;
    pairs.patches.wanted  = tables.templates.concave();
    if (!world.joints.empty()) { pairs.jointed.assign(jointed_pairs(world.joints)); }
    if (decomposition != nullptr)
    {
        ranks.emplace(*decomposition, world, plan.coupling ? sand_reach(scene, world) : 0);
    }
    write_rows(*this);
}

template<class Exec>
std::string BodyState<Exec>::name_of_number(std::int64_t number) const
{
    return number < named() ? "'" + scene.bodies[static_cast<std::size_t>(number)].name + "'"
                            : fmt::format("rock {}", number - named());
}

template<class Exec>
std::vector<double> BodyState<Exec>::radii() const
{
    std::vector<double>             radius = bodies.scale.to_host();
    const std::vector<std::int32_t> shape  = bodies.shape.to_host();
    for (std::size_t row = 0; row < radius.size(); ++row)
    {
        radius[row] *= world.templates[static_cast<std::size_t>(shape[row])].equivalent_radius;
    }
    return radius;
}

template<class Exec>
void BodyState<Exec>::transfer(StateFile& file)
{
    if (ranks && file.exact()) { ranks->transfer(file); }
    if (ranks && file.loads())
    {
        if (!file.exact()) { ranks->take_all(); }
        write_rows(*this);
        dem::forget_list(pairs);
    }
    const BodyBlocks          order        = file.loads() ? BodyBlocks() : blocks();
    const std::vector<double> mass_of_rows = bodies.mass.to_host();
    bodies.for_each_field(
        [&](std::string_view field, auto& array)
        {
            const std::string name = fmt::format("bodies/{}", field);
            auto              rows = array.to_host();
            using Rows             = decltype(rows);
            const auto accepted    = accepted_field(field, file.loads() ? rows : Rows{}, mass_of_rows);
            if (field == "weight") { file.common(name, rows, accepted); } // of named bodies, which all ranks know
            else if (file.loads())
            {
                file.parts(name, rows, of_rows<typename Rows::value_type>(numbers(), accepted));
                rows = numbers().of_rows(rows);
            }
            else
            {
                rows = order.rows(std::move(rows));
                file.parts(name, rows, accepted);
            }
            if (file.loads()) { array.assign(rows); }
        });
    if (!scales_inertia) { return; }
    RowTransfer<Exec> transfer{file, numbers(), order};
    transfer("bodies/inertia_factor", inertia_factor, accept::within(1, accept::largest));
}

#define TREAD_INSTANTIATE(Exec) template struct BodyState<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
