#include "solver/time_step.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/saturated.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"

namespace tread::solver
{
namespace
{

constexpr double contact_warning    = 0.4; ///< dt/N over sqrt(m / sum K), docs/theory.md#time-step
constexpr double point_contact_warn = 2.0;
constexpr double unseen_fall        = dem::rest_reserve; ///< reserve of the pair list over a body's radius
constexpr double overlap_warning    = 0.1;               ///< overlap over radius: the head-on case itself reaches 0.11
constexpr double growth             = 1.05;

struct Bound
{
    double      dt;
    const char* name;
};

/// Number of substeps of a step that no sand limits. They are chosen for the stiffness at its begin, so that they are
/// few unless bodies move little in them: up to `still` while the fastest covers at most `little` smallest radii.
double substeps_alone(double substep, const PaceLimits& limits, const Pace& pace)
{
    constexpr double moving = 10, still = 40, little = 0.02;
    return std::clamp(little * limits.smallest_body / (pace.largest_speed * substep), moving, still);
}

Bound smallest_bound(const scene::TimeOptions& options, const PaceLimits& limits, const Pace& pace)
{
    Bound      least{limits.longest, "longest step"};
    const auto bound = [&](double dt, const char* name)
    {
        if (dt < least.dt) { least = {dt, name}; }
    };
    const bool sand = limits.wave_speed > 0;
    if (sand) { bound(limits.courant * limits.spacing / limits.wave_speed, "compression wave"); }
    const double reach = sand ? limits.spacing : limits.smallest_body;
    if (pace.largest_speed > 0) { bound(displacement_bound * reach / pace.largest_speed, "speed"); }
    if (limits.gravity > 0)
    {
        bound(std::sqrt(2 * displacement_bound * reach / limits.gravity), "free fall");
        if (limits.smallest_body > 0)
        {
            bound(std::sqrt(2 * unseen_fall * limits.smallest_body / limits.gravity), "free fall");
        }
    }
    if (pace.stiffest_point > 0) { bound(std::sqrt(point_contact_bound / pace.stiffest_point), "sand-body contact"); }
    if (!sand && pace.shortest_contact > 0)
    {
        const double substep = options.contact_share * pace.shortest_contact;
        bound(substeps_alone(substep, limits, pace) * substep, "body-body contact");
    }
    return least;
}

} // namespace

std::int64_t substeps_of(const scene::TimeOptions& options, double dt, const PaceLimits& limits, const Pace& pace)
{
    if (options.substeps) { return *options.substeps; }
    double needed = 1;
    if (pace.shortest_contact > 0)
    {
        needed = std::max(needed, std::ceil(dt / (options.contact_share * pace.shortest_contact)));
    }
    if (limits.smallest_body > 0)
    {
        // Rounding of a dt at the same bound must not double the substeps.
        const double displacement = dt * pace.largest_speed / (displacement_bound * limits.smallest_body);
        needed                    = std::max(needed, std::ceil(displacement - 1e-9));
    }
    return saturated(needed);
}

TimeStep choose_step(const scene::TimeOptions& options, const PaceLimits& limits, const Pace& pace, double last_dt)
{
    TimeStep step;
    if (options.dt) { step = {*options.dt, 1, "fixed by the scene"}; }
    else
    {
        const Bound bound = smallest_bound(options, limits, pace);
        step              = {bound.dt, 1, bound.name};
        if (last_dt > 0 && step.dt > growth * last_dt) { step = {growth * last_dt, 1, "growth"}; }
    }
    step.substeps = substeps_of(options, step.dt, limits, pace);
    return step;
}

double fitted(double dt, double remaining)
{
    constexpr double last_steps = 4;
    const double     steps      = std::ceil(remaining / dt * (1 - 1e-12));
    return steps > last_steps ? dt : remaining / std::max(1.0, steps);
}

std::optional<std::string> over_limit(const TimeStep& step, const PaceLimits& limits, const Pace& pace)
{
    if (limits.wave_speed > 0)
    {
        const double courant = limits.wave_speed * step.dt / limits.spacing;
        if (courant > limits.courant * (1 + 1e-9))
        {
            return fmt::format("dt = {:.4g} s: Courant number c_p dt/h = {:.3g} is over {:.3g}", step.dt, courant,
                               limits.courant);
        }
    }
    const double spring = pace.stiffest_point * step.dt * step.dt;
    if (spring > point_contact_warn)
    {
        return fmt::format("dt = {:.4g} s: sand-body contact k dt^2/m_p = {:.3g} is over {}", step.dt, spring,
                           point_contact_warn);
    }
    const double substep = step.dt / static_cast<double>(step.substeps);
    if (pace.shortest_contact > 0 && substep > contact_warning * pace.shortest_contact)
    {
        return fmt::format("substep = {:.4g} s is {:.3g} of sqrt(m / sum K) = {:.4g} s, over {}", substep,
                           substep / pace.shortest_contact, pace.shortest_contact, contact_warning);
    }
    if (pace.overlap > overlap_warning)
    {
        return fmt::format("bodies overlap by {:.3g} of a radius, over {}", pace.overlap, overlap_warning);
    }
    return std::nullopt;
}

} // namespace tread::solver
