#pragma once

#include <cmath>

#include "kernels/dem/contact/body_contact_kern.hpp"

// Rolling resistance: a spring of the relative rolling that yields at a limiting moment, and a damper (J. Ai, J.-F.
// Chen, J. Rotter, J. Ooi, Powder Technology 206 (2011) 269, model C).
namespace tread::dem
{

/// Record of a pair's rolling resistance; all zero while the pair is separated.
struct Rolling
{
    Vec3<double> moment;    ///< N m, on a, normal to the patch's normal
    double       stiffness; ///< N m/rad
    Vec3<double> normal;    ///< unit, normal of the patch at the last update of the record
};

TREAD_HD Rolling no_rolling() { return {Vec3<double>::Zero(), 0.0, Vec3<double>::Zero()}; }

TREAD_HD double held_energy(const Rolling& rolling)
{
    return spring_energy(rolling.moment.squaredNorm(), rolling.stiffness);
}

/// Contribution of the rolling resistance to a pair's response.
struct Resistance
{
    Vec3<double> moment; ///< N m, on a; b gets the opposite moment
    double       energy; ///< J, stored in the spring
    double       lost;   ///< J, dissipated in this substep
};

/// Computes the rolling resistance of a pair that responds with `force` (N, on a) and `contact_stiffness` (N/m), and
/// advances its record by dt (s). `patch` = the pair's, after the substep. The moment is at most mu_r R* F; the
/// stiffness is 9/4 K (mu_r R*)^2, so that the spring yields at a rotation of 4/9 F/(K mu_r R*); the damping ratio is
/// that of the pair, for a ball's moment of inertia 7/5 m* R*^2 about its contact. The damper acts inside the cap and
/// is not stored. Zero without friction, where nothing rolls.
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
