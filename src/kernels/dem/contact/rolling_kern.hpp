#pragma once

#include <cmath>

#include "kernels/dem/contact/body_contact_kern.hpp"

// Resistance to rolling: a spring of the bodies' relative rolling that yields at a moment, and a damper (J. Ai, J.-F.
// Chen, J. Rotter, J. Ooi, Powder Technology 206 (2011) 269, model C).
namespace tread::dem
{

/// What a pair remembers of it; all zero while it is apart.
struct Rolling
{
    Vec3<double> moment;    ///< N m, on a, normal to the patch's normal
    double       stiffness; ///< N m/rad
    Vec3<double> normal;    ///< unit, the patch's when the record was last updated
};

TREAD_HD Rolling no_rolling() { return {Vec3<double>::Zero(), 0.0, Vec3<double>::Zero()}; }

TREAD_HD double held_energy(const Rolling& rolling)
{
    return spring_energy(rolling.moment.squaredNorm(), rolling.stiffness);
}

/// What the resistance adds to a pair's answer.
struct Resistance
{
    Vec3<double> moment; ///< N m, on a; b gets its opposite
    double       energy; ///< J, held by the spring
    double       lost;   ///< J, in this substep
};

/// The resistance of a pair that answers with `force` (N, on a) and `contact_stiffness` (N/m); advances its record by
/// dt (s). `patch` = the pair's, after the substep. Moment at most mu_r R* F; stiffness 9/4 K (mu_r R*)^2, so that it
/// yields at a rotation of 4/9 F/(K mu_r R*); damping ratio that of the pair, of a ball's 7/5 m* R*^2 about its
/// contact. The damper's part acts inside the cap and is not stored. Only where there is friction: without, nothing
/// rolls.
TREAD_HD Resistance resist_rolling(const PairLaw& law, const Patch& patch, const Vec3<double>& force,
                                   double contact_stiffness, const Spins& spins, Rolling& rolling, double dt)
{
    const double       held   = held_energy(rolling);
    const Vec3<double> normal = patch.normal;
    const double       load   = normal.dot(force);
    if (!(load > 0) || !(law.rolling_friction > 0))
    {
        rolling = no_rolling();
        return {Vec3<double>::Zero(), 0, held};
    }
    const double arm       = law.rolling_friction * law.effective_radius;
    const double stiffness = 2.25 * contact_stiffness * arm * arm;
    const double cap       = arm * load;
    const double viscosity =
        2.0 * law.damping_ratio * law.effective_radius * std::sqrt(stiffness * 1.4 * law.reduced_mass);
    const Vec3<double> spin = spins.a - spins.b, rate = spin - normal * normal.dot(spin);

    Vec3<double> moment = turn_with_normal(rolling.moment, rolling.normal, normal);
    moment              = turn_about(moment, normal, 0.5 * dt * (spins.a + spins.b).dot(normal));
    if (stiffness < rolling.stiffness) { moment *= stiffness / rolling.stiffness; }
    const double turned = spring_energy(moment.squaredNorm(), stiffness);
    moment -= stiffness * dt * rate;
    const double length = moment.norm();
    const double yield  = length > cap ? cap * (length - cap) / stiffness : 0.0;
    moment *= cap_factor(length, cap);

    Vec3<double> total = moment - viscosity * rate;
    total *= cap_factor(total.norm(), cap);
    rolling = {moment, stiffness, normal};
    return {total, held_energy(rolling), held - turned + yield - dt * (total - moment).dot(rate)};
}

} // namespace tread::dem
