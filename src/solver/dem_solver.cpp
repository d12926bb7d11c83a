#include "solver/dem_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "kernels/dem/contact/body_contact.hpp"
#include "kernels/dem/contact/contact_limits.hpp"
#include "kernels/dem/motion/move.hpp"
#include "kernels/dem/motion/substeps.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"
#include "world/materials.hpp"

namespace tread::solver
{
namespace
{

constexpr double hit_twice = 4; ///< speed of a light body hit by one that was itself hit, over the largest now

/// A body that a surface at speed v begins to push with stiffness K moves v (t - sin(w t) / w) in a time t,
/// w = sqrt(K / m); off its centre a ball yields 7/2 times as easily. Up to t = sqrt(m / K) that is less than
/// hit_soon v t.
constexpr double hit_soon = 0.5;

constexpr std::int64_t batches_ahead = 2; ///< batches of substeps covered by a check, as its readback takes one

/// Share of a step over which displacements are extrapolated at its start, if the list is also checked within the
/// step.
constexpr double watched_share = 0.5;

/// Spacings: largest distance from its rank's pages at which sand can touch a body. Points may be up to a page outside
/// before they migrate, and have a radius.
constexpr double sand_reach = mpm::page_edge + 2;

std::vector<double> bounding_radii(const world::World& world)
{
    std::vector<double> radii;
    for (std::size_t b = 0; b < world.bodies.size(); ++b)
    {
        const auto shape = static_cast<std::size_t>(world.bodies.shape[b]);
        radii.push_back(world.templates[shape].bounding_radius * world.bodies.scale[b]);
    }
    return radii;
}

} // namespace

template<class Exec>
DemSolver<Exec>::DemSolver(const Exec& exec, const scene::Scene& scene, const world::World& world, const Plan& plan,
                           decomp::Decomposition<Exec>* decomposition)
    : exec_(exec)
    , scene_(scene)
    , world_(world)
    , gravity_(scene.domain.gravity.data())
    , named_(world.bodies.named)
    , contacts_(plan.body_contact)
    , templates_(exec, world.templates)
    , rays_(exec, plan.rays ? world.templates : std::vector<shape::ShapeTemplate>{})
    , bodies_(exec)
    , pairs_(exec)
    , properties_(exec, "pair properties")
    , planes_(exec, "walls")
    , totals_(exec, "body totals")
    , impulses_(exec, "contact impulses")
    , bounding_radii_(exec, "body bounding radii")
    , sums_(exec, "body sums", sizeof(ReportSums) / sizeof(double))
    , readback_(exec, "body sums on the host")
    , displacement_readback_(exec, "body travel on the host")
    , overlap_readback_(exec, "body overlap on the host")
    , lookahead_readback_(exec, "body travel ahead on the host")
    , lookahead_done_(exec)
    , displacements_(exec)
    , released_(static_cast<std::size_t>(named_), false)
    , commanded_(static_cast<std::size_t>(named_))
    , kept_impulses_(static_cast<std::size_t>(named_), Vec3<double>::Zero())
{
    const std::size_t sides = world.bodies.size() + world.planes.size();
    if (sides > static_cast<std::size_t>(dem::most_bodies))
    {
        throw InputError(fmt::format("{} bodies and walls: at most {} can be told apart", sides, dem::most_bodies));
    }
    upload(world);
    const std::vector<dem::PairProperties> properties = world::pair_properties(scene);
    properties_.assign(properties);
    pairs_.resists_rolling =
        std::any_of(properties.begin(), properties.end(), [](const auto& pair) { return pair.rolling_friction > 0; });
    pairs_.patches.wanted = templates_.concave();
    planes_.assign(world.planes);
    law_             = {templates_.views(),
                        {properties_.data(), static_cast<std::int32_t>(scene.materials.size() + 1)},
                        planes_.data(),
                        static_cast<std::int32_t>(world.planes.size()),
                        {world::hertz_factor(scene.numerics.hertz), scene.numerics.linear_overlap},
                        rays_.views()};
    const auto count = static_cast<std::int64_t>(world.bodies.size());
    totals_.resize(count);
    totals_.fill_zero();
    taken_                          = read(exec_, totals_.data()); // zero for all bodies
    const std::vector<double> radii = bounding_radii(world);
    bounding_radii_.assign(radii);
    smallest_radius_ = *std::min_element(radii.begin(), radii.end());
    impulses_.resize(named_);
    impulses_.fill_zero();
    if (contacts_) { dem::classify_bodies(exec_, pairs_, bodies_.view(), templates_.views()); }
    bodies_.force.fill_zero();
    bodies_.torque.fill_zero();
    bodies_.stiffness.fill_zero();
    if (decomposition != nullptr)
    {
        ranks_.emplace(*decomposition, world, plan.coupling ? sand_reach * scene.grid.spacing : 0, bodies_);
    }
    begin_mean();
    restore_contacts();
}

template<class Exec>
void DemSolver<Exec>::upload(const world::World& world)
{
    const world::HostBodies&   host = world.bodies;
    const std::size_t          n    = host.size();
    std::vector<Sym3<double>>  inertia;
    std::vector<std::uint32_t> locked(n, 0);
    std::vector<std::int32_t>  damped(n, 1);
    for (std::size_t b = 0; b < n; ++b)
    {
        const auto& unit = world.templates[static_cast<std::size_t>(host.shape[b])].unit;
        // At scale s a mass m has the inertia of density m / (s^3 V): m / V times s^2 times that of density 1.
        inertia.push_back(
            symmetric<double>(unit.inertia * (host.mass[b] / unit.volume * host.scale[b] * host.scale[b])));
        mass_ += host.mass[b];
        if (b < static_cast<std::size_t>(named_))
        {
            locked[b] = dem::lock_all;
            damped[b] = 0;
        }
    }
    bodies_.position.assign(host.position);
    bodies_.orientation.assign(host.orientation);
    bodies_.velocity.assign(std::vector<Vec3<double>>(n, Vec3<double>::Zero()));
    bodies_.angular_velocity.assign(std::vector<Vec3<double>>(n, Vec3<double>::Zero()));
    bodies_.mass.assign(host.mass);
    bodies_.inertia.assign(inertia);
    bodies_.scale.assign(host.scale);
    bodies_.shape.assign(host.shape);
    bodies_.material.assign(host.material);
    bodies_.locked.assign(locked);
    bodies_.weight.assign(std::vector<double>(static_cast<std::size_t>(named_), 1.0));
    bodies_.damped.assign(damped);
    const auto count = static_cast<std::int64_t>(n);
    bodies_.force.resize(count);
    bodies_.torque.resize(count);
    bodies_.stiffness.resize(count);
}

template<class Exec>
std::string DemSolver<Exec>::name(std::int64_t body) const
{
    return body < named_ ? "'" + scene_.bodies[static_cast<std::size_t>(body)].name + "'"
                         : fmt::format("rock {}", body - named_);
}

template<class Exec>
void DemSolver<Exec>::find_pairs(double dt)
{
    if (list_holds(dt)) { stage(); } // commands change bodies too
    else { list_pairs_anew(dt); }
    dem::expect_contacts(exec_, pairs_, bodies_.view(), law_, gravity_, dt, shared());
    if (!ranks_) { return; }
    ranks_->exchange_stiffness();
    dem::expect_shared_contacts(exec_, pairs_, shared());
}

/// Changes nothing before the list is known to hold on all ranks.
template<class Exec>
bool DemSolver<Exec>::list_holds(double dt)
{
    const bool   known = listed_ && !(ranks_ && ranks_->pages_have_changed());
    const double ahead = checked_within_step_ ? watched_share * dt : dt;
    if (!known || of_all(read(exec_, largest_displacement_ahead(ahead))) > 1) { return false; }
    if (!pairs_.patches.wanted) { return true; }
    if (of_all(dem::patch_rows_suffice(exec_, pairs_, bodies_.view(), law_) ? 0 : 1) > 0) { return false; }
    dem::regroup_patches(exec_, pairs_, bodies_.view(), law_);
    return true;
}

template<class Exec>
const double* DemSolver<Exec>::largest_displacement_ahead(double ahead)
{
    return dem::largest_displacement_ahead(exec_, displacements_, bodies_.view(), law_.templates, pairs_.travel.data(),
                                           ahead);
}

template<class Exec>
void DemSolver<Exec>::list_pairs_anew(double dt)
{
    dem::begin_list(exec_, pairs_, bodies_.view(), law_);
    if (shares())
    {
        dem::share_speeds(exec_, pairs_, bodies_.view(), shared());
        ranks_->exchange_speeds();
    }
    dem::request_displacement(exec_, pairs_, bodies_.view(), law_, dt, shared());
    if (ranks_) { ranks_->sum_wanted_travel(pairs_); }
    dem::allow_displacement(exec_, pairs_, bodies_.view(), law_, dt, substep_ > 0 ? dt / substep_ : 1);
    if (ranks_)
    {
        ranks_->assign_owners(bodies_, pairs_);
        ++partition_version_;
    }
    dem::list_pairs(exec_, pairs_, bodies_.view(), law_);
    dem::mark_places(exec_, displacements_, bodies_.view());
    listed_ = true;
}

template<class Exec>
std::int64_t DemSolver<Exec>::substeps_without_check(const TimeStep& step, double speed, double contact_time)
{
    lookahead_pending_  = false;
    const auto   number = static_cast<double>(step.substeps);
    const double dt = step.dt / number, reserve = dem::rest_reserve * smallest_radius_,
                 fall    = heaviest_ * gravity_.norm() * step.dt;
    const double unseen  = reserve / (dt * (hit_twice * speed + fall)); // in substeps
    checked_within_step_ = number > unseen;
    if (!checked_within_step_) { return step.substeps; }
    const double soon  = std::min(contact_time / dt, reserve / (dt * (hit_soon * speed + fall)));
    const double batch = std::max(unseen, soon) / static_cast<double>(batches_ahead);
    return static_cast<std::int64_t>(std::clamp(batch, 1.0, number));
}

template<class Exec>
std::int64_t DemSolver<Exec>::steps_without_check(double dt, double speed) const
{
    if (!contacts_) { return std::numeric_limits<std::int64_t>::max(); }
    // Displacement bound of n steps by speed and gravity: n dt (4 v + g n dt) <= reserve.
    const double fall = heaviest_ * gravity_.norm(), reserve = dem::rest_reserve * smallest_radius_,
                 start = hit_twice * speed;
    const double span  = 2 * reserve / (start + std::sqrt(start * start + 4 * fall * reserve));
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::min(span / dt, 1e9)));
}

template<class Exec>
void DemSolver<Exec>::find_pairs_if_displaced(const TimeStep& step, std::int64_t batch, std::int64_t done, double time)
{
    const double dt = step.dt / static_cast<double>(step.substeps);
    if (is_displaced_too_far()) { find_pairs_within(step, time + dt * static_cast<double>(done)); }
    else { request_lookahead(dt * static_cast<double>(std::min(batches_ahead * batch, step.substeps - done))); }
}

template<class Exec>
void DemSolver<Exec>::request_lookahead(double ahead)
{
    lookahead_readback_.request(largest_displacement_ahead(ahead));
    lookahead_done_.mark();
    lookahead_pending_ = true;
}

/// Also false where no check was requested: a list found since then holds for two batches.
template<class Exec>
bool DemSolver<Exec>::is_displaced_too_far()
{
    if (!std::exchange(lookahead_pending_, false)) { return false; }
    lookahead_done_.wait();
    return of_all(lookahead_readback_.get()) > 1;
}

/// The list is built for a whole step, so that it may serve the next.
template<class Exec>
void DemSolver<Exec>::find_pairs_within(const TimeStep& step, double time)
{
    together(
        [&]
        {
            require_finite(time);
            const double overlap = read(exec_, dem::largest_overlap(exec_, pairs_, bodies_.view(), law_));
            overlap_             = std::max(overlap_, guard(time, overlap)); // the search resets the peaks of the pairs
        });
    find_pairs(step.dt);
}

template<class Exec>
double DemSolver<Exec>::shortest_contact()
{
    const double here = dem::smallest_contact_time(exec_, pairs_, bodies_.view());
    return ranks_ ? ranks_->shortest(here) : here;
}

template<class Exec>
ContactCount DemSolver<Exec>::count_contacts()
{
    const std::vector<double> stiffness = pairs_.answers.stiffness.to_host();
    const auto live = std::count_if(stiffness.begin(), stiffness.end(), [](double value) { return value > 0; });
    return {static_cast<double>(stiffness.size()), static_cast<double>(live), static_cast<double>(pairs_.node.size())};
}

template<class Exec>
void DemSolver<Exec>::contact(double dt)
{
    dem::evaluate_contacts(exec_, pairs_, bodies_.view(), law_, dt);
}

template<class Exec>
void DemSolver<Exec>::move(double dt, double damping, const dem::OutsideWrenches& outside)
{
    dem::BodyStep<Exec> step = body_step(dt, damping);
    step.motion.outside      = outside;
    if (shares())
    {
        dem::share_wrenches(exec_, step);
        ranks_->exchange_wrenches();
    }
    dem::move_bodies(exec_, step);
    count_substeps(dt, 1);
}

template<class Exec>
void DemSolver<Exec>::run(double dt, double damping, std::int64_t count)
{
    if (shares())
    {
        for (std::int64_t substep = 0; substep < count; ++substep)
        {
            contact(dt);
            move(dt, damping);
        }
        return;
    }
    dem::run_substeps(exec_, body_step(dt, damping), count);
    count_substeps(dt, count);
}

template<class Exec>
dem::BodyStep<Exec> DemSolver<Exec>::body_step(double dt, double damping)
{
    return {pairs_, bodies_.view(), law_, totals_.data(), named_impulses(), {gravity_, damping, dt}, shared()};
}

template<class Exec>
void DemSolver<Exec>::count_substeps(double dt, std::int64_t count)
{
    mean_time_ += static_cast<double>(count) * dt;
    substep_ = dt;
}

#define TREAD_INSTANTIATE(Exec) template class DemSolver<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
