#pragma once

#include <algorithm>
#include <cmath>

#include "dem_impact.hpp"

// Reference solution of a ball's oblique impact by Hertz and Mindlin, independent of the kernels: three equations of
// motion in the plane.
namespace tread::test
{

/// Treatment of the tangential force during unloading, when the contact's stiffness falls.
enum class Unloading
{
    keeps,   ///< it is kept, as in most codes; a closed cycle may generate energy
             ///< (docs/verification.md#closed-cycles-of-friction)
    shrinks, ///< it falls with the stiffness, as in the kernels
};

/// Uses Mindlin's spring without micro-slip, 8 G* sqrt(R d), and the damping of the kernels (sphere_contact_kern.hpp,
/// patch_kern.hpp), by symplectic Euler with `steps` in the duration of the undamped contact.
inline Rebound mindlin_rebound(const Throw& thrown, Unloading unloading, int steps)
{
    const auto   pair = properties(thrown.material.young, thrown.material.poisson, 1, 0, 0);
    const double mass = mass_of(thrown), zeta = damping_ratio(thrown.restitution);
    const double dt      = undamped(thrown).duration / steps;
    double       overlap = 0, rate = thrown.normal, along = thrown.tangential, spin = thrown.spin;
    double       spring = 0, last = 0;
    for (int step = 0; step < 10 * steps; ++step)
    {
        overlap += dt * rate;
        if (overlap <= 0) { break; }
        const double root = std::sqrt(thrown.radius * overlap), stiffness = 2 * pair.effective_young * root;
        const double k_tangential = 8 * pair.effective_shear * root, arm = thrown.radius - overlap;
        const double damping = 2 * zeta * std::sqrt(5.0 / 6 * mass * stiffness) * rate;
        const double load = std::max(2.0 / 3 * stiffness * overlap + damping, 0.0), cap = thrown.friction * load;
        const double slip = along - arm * spin;

        if (unloading == Unloading::shrinks && stiffness < last) { spring *= stiffness / last; }
        last               = stiffness;
        spring             = std::clamp(spring - k_tangential * dt * slip, -cap, cap);
        const double force = std::clamp(spring - 2 * zeta * std::sqrt(k_tangential * mass) * slip, -cap, cap);
        rate -= dt * load / mass;
        along += dt * force / mass;
        spin -= dt * force * arm / (0.4 * mass * thrown.radius * thrown.radius);
    }
    return {-rate, along, spin};
}

/// Mean overlap over the largest, weighted by Hertz's force over an undamped impact; it shortens the lever arm of the
/// spin. int d F dt / (d_max int F dt) = B(7/5, 1/2) / 2.
inline double mean_overlap() { return 0.5 * std::beta(1.4, 0.5); }

} // namespace tread::test
