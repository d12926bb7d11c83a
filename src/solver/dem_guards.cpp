#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "kernels/dem/contact/contact_limits.hpp"
#include "solver/dem_solver.hpp"

// Checks that stop a run with an invalid state of bodies, naming the body.
namespace tread::solver
{
namespace
{

constexpr double deepest_overlap = 0.5; ///< overlap over radius: beyond it a contact's direction is undefined
constexpr double longest_leap    = 1;   ///< displacement in a substep over the smallest radius

} // namespace

/// Returns `ratio`, the largest overlap over radius (dem::largest_overlap), if the law is valid for it; else throws.
template<class Exec>
double DemSolver<Exec>::guard(double time, double ratio)
{
    if (ratio <= deepest_overlap) { return ratio; }
    const std::uint64_t key  = dem::deepest_pair(pairs_, ratio);
    const bool          wall = dem::second_of(key) >= bodies_.position.size();
    throw NumericalError(fmt::format(
        "t = {:.6g} s: body {} overlaps {} by {:.3g} of its radius, over the {} that the contact "
        "law can carry: stiffer bodies, or a smaller dt",
        time, name(dem::first_of(key)), wall ? "a wall" : name(dem::second_of(key)), ratio, deepest_overlap));
}

/// Throws for the first body whose velocity or force is not finite.
template<class Exec>
void DemSolver<Exec>::require_finite(double time)
{
    const std::vector<Vec3<double>> position = bodies_.position.to_host(), velocity = bodies_.velocity.to_host(),
                                    spin = bodies_.angular_velocity.to_host(), force = bodies_.force.to_host(),
                                    torque = bodies_.torque.to_host();
    for (std::size_t b = 0; b < position.size(); ++b)
    {
        const auto values = {&position[b], &velocity[b], &spin[b], &force[b], &torque[b]};
        if (std::all_of(values.begin(), values.end(),
                        [](const Vec3<double>* value) { return std::isfinite(value->norm()); }))
        {
            continue;
        }
        throw NumericalError(fmt::format("t = {:.6g} s: the position, velocity or force of body {} is not a number",
                                         time, name(static_cast<std::int64_t>(b))));
    }
}

/// Throws after a step without checks if a body may have touched another that the pair list lacks.
template<class Exec>
void DemSolver<Exec>::require_listed(double time, double largest)
{
    if (largest <= 1) { return; }
    if (std::isinf(largest)) { require_finite(time); }
    const std::vector<double> shares = displacements_.share.to_host();
    const auto                body   = std::find(shares.begin(), shares.end(), largest) - shares.begin();
    throw NumericalError(fmt::format("t = {:.6g} s: body {} moved {:.3g} times as far in a step as the search for its "
                                     "contacts allowed (at most 1): a smaller dt",
                                     time, name(body), largest));
}

/// Throws if a body moves so far in a substep that it may pass through the smallest body without contact.
template<class Exec>
void DemSolver<Exec>::require_resolved(double time, double speed)
{
    const double leap = speed * substep_;
    if (leap <= longest_leap * smallest_radius_) { return; }
    const std::vector<dem::BodyActivity> rows = activity_->to_host();
    const auto body = std::find_if(rows.begin(), rows.end(), [&](const auto& one) { return one.speed == speed; });
    throw NumericalError(fmt::format("t = {:.6g} s: body {} moves {:.4g} m in a substep, {:.3g} of the smallest body's "
                                     "radius (at most {}): more substeps, or a smaller dt",
                                     time, name(body - rows.begin()), leap, leap / smallest_radius_, longest_leap));
}

/// The rank that holds the stiffest body names it.
template<class Exec>
void DemSolver<Exec>::refuse_substeps(const TimeStep& step, const Pace& pace, double time)
{
    const std::string start = fmt::format(
        "t = {:.6g} s: a step of {:.4g} s would take {:.3g} contact substeps, over the {} that a step may have", time,
        step.dt, static_cast<double>(step.substeps), scene::most_substeps);
    const double own = dem::smallest_contact_time(exec_, pairs_, bodies_.view());
    const double all = ranks_ ? ranks_->shortest(own) : own, share = scene_.time.contact_share;
    const bool   too_stiff = all > 0 && step.dt > share * all * static_cast<double>(scene::most_substeps);
    together(
        [&]
        {
            if (!too_stiff || own != all) { return; }
            const auto body = dem::stiffest_body(pairs_, static_cast<std::int64_t>(bodies_.position.size()));
            throw NumericalError(
                fmt::format("{}: sqrt(m / sum K) of body {} is {:.3g} s, of which a substep takes "
                            "time.contact_share = {}: a softer material or a heavier body, a smaller dt, "
                            "or a larger contact_share",
                            start, name(body), all, share));
        });
    throw NumericalError(
        fmt::format("{}: something moves at {:.4g} m/s, and the smallest body has a radius of {:.3g} m: "
                    "a smaller dt",
                    start, pace.largest_speed, smallest_radius_));
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template double DemSolver<Exec>::guard(double, double);                                                            \
    template void   DemSolver<Exec>::require_finite(double);                                                           \
    template void   DemSolver<Exec>::require_listed(double, double);                                                   \
    template void   DemSolver<Exec>::require_resolved(double, double);                                                 \
    template void   DemSolver<Exec>::refuse_substeps(const TimeStep&, const Pace&, double)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
