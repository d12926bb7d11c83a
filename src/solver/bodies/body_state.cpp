#include "solver/bodies/body_state.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

/// Spacings: largest distance from its rank's pages at which sand can touch a body. Points may be up to a page outside
/// before they migrate, and have a radius.
constexpr double sand_reach = mpm::page_edge + 2;

constexpr double freedoms = dem::all_flags; ///< all bits of BodiesView::locked
constexpr double furthest = 1e6;            ///< m, largest accepted distance of a body from the domain's corner
constexpr double fastest  = 1e6;            ///< m/s and rad/s: steps with faster bodies would not end
constexpr double shortest = 1e-10;          ///< s, smallest accepted sqrt(m / K) of a body with contacts of stiffness K

void require_distinct_keys(const world::World& world)
{
    const std::size_t sides = world.bodies.size() + world.planes.size();
    if (sides <= static_cast<std::size_t>(dem::most_bodies)) { return; }
    throw InputError(fmt::format("{} bodies and walls: at most {} can be told apart", sides, dem::most_bodies));
}

/// Copies the world's bodies to the backend, at rest and named ones locked.
template<class Exec>
void upload(BodyState<Exec>& state)
{
    const world::World&        world  = state.world;
    const world::HostBodies&   host   = world.bodies;
    dem::Bodies<Exec>&         bodies = state.bodies;
    const auto                 named  = static_cast<std::size_t>(state.named());
    const std::size_t          n      = host.size();
    std::vector<Sym3<double>>  inertia;
    std::vector<std::uint32_t> locked(n, 0);
    std::vector<std::int32_t>  damped(n, 1);
    for (std::size_t b = 0; b < n; ++b)
    {
        const auto& unit = world.templates[static_cast<std::size_t>(host.shape[b])].unit;
        // At scale s a mass m has the inertia of density m / (s^3 V): m / V times s^2 times that of density 1.
        inertia.push_back(
            symmetric<double>(unit.inertia * (host.mass[b] / unit.volume * host.scale[b] * host.scale[b])));
        state.mass += host.mass[b];
        if (b < named)
        {
            locked[b] = dem::lock_all;
            damped[b] = 0;
        }
    }
    bodies.position.assign(host.position);
    bodies.orientation.assign(host.orientation);
    bodies.velocity.assign(std::vector<Vec3<double>>(n, Vec3<double>::Zero()));
    bodies.angular_velocity.assign(std::vector<Vec3<double>>(n, Vec3<double>::Zero()));
    bodies.mass.assign(host.mass);
    bodies.inertia.assign(inertia);
    bodies.scale.assign(host.scale);
    bodies.shape.assign(host.shape);
    bodies.material.assign(host.material);
    bodies.locked.assign(locked);
    bodies.weight.assign(std::vector<double>(named, 1.0));
    bodies.damped.assign(damped);
    const auto count = static_cast<std::int64_t>(n);
    bodies.force.resize(count);
    bodies.torque.resize(count);
    bodies.stiffness.resize(count);
    bodies.force.fill_zero();
    bodies.torque.fill_zero();
    bodies.stiffness.fill_zero();
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

/// Accepts contact stiffnesses of bodies that do not require endless substeps.
auto accepted_stiffness(const world::HostBodies& bodies)
{
    const auto most = [&bodies](std::size_t b) { return bodies.mass[b] / (shortest * shortest); };
    return accept::each_at([most](std::size_t b, double value) { return 0 <= value && value <= most(b); },
                           [most](std::size_t b) { return fmt::format("0 to {}", most(b)); });
}

/// Accepts valid values of a body field; `present`: the scene's values, as sizes, shapes and materials must not
/// change.
template<class T>
auto accepted_field(std::string_view name, std::vector<T> present, const world::HostBodies& bodies)
{
    return [name, &bodies, present = std::move(present)](const std::vector<T>& values) -> accept::Verdict
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
            if (name == "stiffness") { return accepted_stiffness(bodies)(values); }
            return name == "weight" ? accept::finite()(values) : accept::same_as(present)(values);
        }
        else if (name == "inertia") { return accept::same_as(present)(values); }
        else if (name == "position") { return accept::within(-furthest, furthest)(values); }
        else if (name == "force" || name == "torque") { return accept::finite()(values); }
        else { return accept::within(-fastest, fastest)(values); }
    };
}

} // namespace

template<class Exec>
BodyState<Exec>::BodyState(const Exec& backend, const scene::Scene& of_scene, const world::World& of_world,
                           const Plan& plan, decomp::Decomposition<Exec>* decomposition)
    : exec(backend)
    , scene(of_scene)
    , world(of_world)
    , gravity(of_scene.domain.gravity.data())
    , has_contact(plan.body_contact)
    , tables(backend, of_scene, of_world, plan)
    , bodies(backend)
    , pairs(backend)
{
    require_distinct_keys(world);
    upload(*this);
    pairs.resists_rolling = tables.rolling;
    pairs.patches.wanted  = tables.templates.concave();
    if (!world.joints.empty()) { pairs.jointed.assign(jointed_pairs(world.joints)); }
    if (has_contact) { dem::classify_bodies(exec, pairs, bodies.view(), tables.law.templates); }
    if (decomposition != nullptr)
    {
        ranks.emplace(*decomposition, world, plan.coupling ? sand_reach * scene.grid.spacing : 0, bodies);
    }
}

template<class Exec>
std::string BodyState<Exec>::name(std::int64_t body) const
{
    return body < named() ? "'" + scene.bodies[static_cast<std::size_t>(body)].name + "'"
                          : fmt::format("rock {}", body - named());
}

template<class Exec>
void BodyState<Exec>::transfer(StateFile& file)
{
    const BodyBlocks order = file.loads() ? BodyBlocks() : blocks();
    bodies.for_each_field(
        [&](std::string_view field, auto& array)
        {
            const std::string name     = fmt::format("bodies/{}", field);
            auto              rows     = array.to_host();
            const auto        accepted = accepted_field(field, file.loads() ? rows : decltype(rows){}, world.bodies);
            if (field == "weight") { file.common(name, rows, accepted); } // of named bodies, which all ranks know
            else
            {
                if (!file.loads()) { rows = order.rows(std::move(rows)); }
                file.parts(name, rows, accepted);
            }
            if (file.loads()) { array.assign(rows); }
        });
}

#define TREAD_INSTANTIATE(Exec) template struct BodyState<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
