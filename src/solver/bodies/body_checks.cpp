#include "solver/bodies/body_checks.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "kernels/dem/contact/contact_limits.hpp"
#include "solver/ranks/over_ranks.hpp"

namespace tread::solver
{
namespace
{

constexpr double deepest_overlap = 0.5; ///< overlap over radius: beyond it a contact's direction is undefined
constexpr double longest_leap    = 1;   ///< displacement in a substep over the smallest radius

} // namespace

template<class Exec>
void require_shallow(BodyState<Exec>& state, double overlap, double time)
{
    if (overlap <= deepest_overlap) { return; }
    const std::uint64_t key  = dem::deepest_pair(state.pairs, overlap);
    const bool          wall = dem::second_of(key) >= state.bodies.position.size();
    throw NumericalError(
        fmt::format("t = {:.6g} s: body {} overlaps {} by {:.3g} of its radius, over the {} that the contact "
                    "law can carry: stiffer bodies, or a smaller dt",
                    time, state.name(dem::first_of(key)), wall ? "a wall" : state.name(dem::second_of(key)), overlap,
                    deepest_overlap));
}

template<class Exec>
void require_finite(const BodyState<Exec>& state, double time)
{
    const dem::Bodies<Exec>&        bodies   = state.bodies;
    const std::vector<Vec3<double>> position = bodies.position.to_host(), velocity = bodies.velocity.to_host(),
                                    spin = bodies.angular_velocity.to_host(), force = bodies.force.to_host(),
                                    torque = bodies.torque.to_host();
    for (std::size_t b = 0; b < position.size(); ++b)
    {
        const auto values = {&position[b], &velocity[b], &spin[b], &force[b], &torque[b]};
        if (std::all_of(values.begin(), values.end(),
                        [](const Vec3<double>* value) { return std::isfinite(value->norm()); }))
        {
            continue;
        }
        throw NumericalError(fmt::format("t = {:.6g} s: the position, velocity or force of body {} is not a number",
                                         time, state.name(static_cast<std::int64_t>(b))));
    }
}

template<class Exec>
void require_listed(const BodyState<Exec>& state, const dem::DisplacementTracker<Exec>& displacements, double share,
                    double time)
{
    if (share <= 1) { return; }
    if (std::isinf(share)) { require_finite(state, time); }
    const std::vector<double> shares = displacements.share.to_host();
    const auto                body   = std::find(shares.begin(), shares.end(), share) - shares.begin();
    throw NumericalError(fmt::format("t = {:.6g} s: body {} moved {:.3g} times as far in a step as the search for its "
                                     "contacts allowed (at most 1): a smaller dt",
                                     time, state.name(body), share));
}

template<class Exec>
void require_resolved(const BodyState<Exec>& state, const Array<Exec, dem::BodyActivity>& activity, double speed,
                      double substep, double time)
{
    const double leap = speed * substep, radius = state.tables.smallest_radius;
    if (leap <= longest_leap * radius) { return; }
    const std::vector<dem::BodyActivity> rows = activity.to_host();
    const auto body = std::find_if(rows.begin(), rows.end(), [&](const auto& one) { return one.speed == speed; });
    throw NumericalError(fmt::format("t = {:.6g} s: body {} moves {:.4g} m in a substep, {:.3g} of the smallest body's "
                                     "radius (at most {}): more substeps, or a smaller dt",
                                     time, state.name(body - rows.begin()), leap, leap / radius, longest_leap));
}

/// The rank that holds the stiffest body names it.
template<class Exec>
void refuse_substeps(BodyState<Exec>& state, const TimeStep& step, const Pace& pace, double time)
{
    const std::string start = fmt::format(
        "t = {:.6g} s: a step of {:.4g} s would take {:.3g} contact substeps, over the {} that a step may have", time,
        step.dt, static_cast<double>(step.substeps), scene::most_substeps);
    const double own = dem::smallest_contact_time(state.exec, state.pairs, state.view(), state.mass_scaling);
    const double all = smallest_over_ranks(state.communicator(), own), share = state.scene.time.contact_share;
    const bool   too_stiff = all > 0 && step.dt > share * all * static_cast<double>(scene::most_substeps);
    check_on_ranks(state.communicator(),
                   [&]
                   {
                       if (!too_stiff || own != all) { return; }
                       const auto body = dem::stiffest_body(state.pairs, state.bodies.position.size());
                       throw NumericalError(
                           fmt::format("{}: sqrt(m / sum K) of body {} is {:.3g} s, of which a substep takes "
                                       "time.contact_share = {}: a softer material or a heavier body, a smaller dt, "
                                       "or a larger contact_share",
                                       start, state.name(body), all, share));
                   });
    throw NumericalError(
        fmt::format("{}: something moves at {:.4g} m/s, and the smallest body has a radius of {:.3g} m: "
                    "a smaller dt",
                    start, pace.largest_speed, state.tables.smallest_radius));
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void require_finite(const BodyState<Exec>&, double);                                                      \
    template void require_shallow(BodyState<Exec>&, double, double);                                                   \
    template void require_listed(const BodyState<Exec>&, const dem::DisplacementTracker<Exec>&, double, double);       \
    template void require_resolved(const BodyState<Exec>&, const Array<Exec, dem::BodyActivity>&, double, double,      \
                                   double);                                                                            \
    template void refuse_substeps(BodyState<Exec>&, const TimeStep&, const Pace&, double)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
