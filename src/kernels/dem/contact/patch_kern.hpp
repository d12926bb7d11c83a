#pragma once

#include <cmath>
#include <numbers>

#include "kernels/dem/contact/spring_kern.hpp"
#include "kernels/dem/contact/traction_kern.hpp"

// Contact record of a pair of bodies and the friction that follows from it: docs/theory.md#friction, one record per
// patch.
namespace tread::dem
{

/// Friction record; all zero while the pair is separated. "On a" = on the pair's first body. World frame.
struct Patch
{
    Vec3<double> tangential;      ///< N, on a
    Vec3<double> normal;          ///< unit, towards a, at the last update of the record
    double       torsion;         ///< N m, on a, about the normal
    double       stiffness;       ///< N/m, K; k_t = (4 G*/E*) K
    double       twist_stiffness; ///< N m/rad, k_theta
};

TREAD_HD Patch no_patch() { return {Vec3<double>::Zero(), Vec3<double>::Zero(), 0.0, 0.0, 0.0}; }

/// Result of the normal law, and relative motion of the two sides at the patch.
struct PatchState
{
    Vec3<double> normal;      ///< unit, towards a
    double       load;        ///< N, |F|
    double       stiffness;   ///< N/m, K
    double       spread;      ///< m2, sum f |x - x_c|_t^2 / sum f
    Vec3<double> velocity;    ///< m/s, of a relative to b at x_c
    double       spin;        ///< rad/s, of a relative to b about the normal
    double       common_spin; ///< rad/s, mean of both about the normal
};

struct Friction
{
    Vec3<double> force;  ///< N, on a at x_c
    double       moment; ///< N m, on a about the normal
    double       energy; ///< J, stored in the springs
    double       lost;   ///< J, dissipated in this substep
};

/// Returns the energy stored in the springs of a patch of the pair.
TREAD_HD double held_energy(const PairLaw& law, const Patch& patch)
{
    return spring_energy(patch.tangential.squaredNorm(), law.shear_ratio * patch.stiffness) +
           spring_energy(patch.torsion * patch.torsion, patch.twist_stiffness);
}

/// Rotates about the unit normal by a small angle (rad) and keeps the length: Cayley's form, with an angle error of
/// angle^3/12.
TREAD_HD Vec3<double> turn_about(const Vec3<double>& force, const Vec3<double>& normal, double angle)
{
    const double half = 0.5 * angle, over = 1.0 / (1.0 + half * half);
    return over * ((1.0 - half * half) * force + angle * normal.cross(force));
}

/// Returns 1, or the factor that reduces `value` to `cap`.
TREAD_HD double cap_factor(double value, double cap) { return value > cap ? cap / value : 1.0; }

/// Advances the record by dt (s): springs are rotated with the patch, loaded by its motion, reduced when their
/// stiffness falls (otherwise a closed cycle creates energy, docs/theory.md#friction), and capped by Coulomb's law;
/// damping acts inside the caps and is not stored. The torsion spring is reduced with its own stiffness. Its cap is
/// that of a Hertz patch of radius a in full slip, 3 pi/16 mu F a = 0.94 mu F r with r^2 = 0.4 a^2 = 0.4 R* d.
TREAD_HD Friction update_patch(const PairLaw& law, const PatchState& state, Patch& patch, double dt)
{
    const double soft_before       = softness_of(law.shear_ratio * patch.stiffness);
    const double twist_soft_before = softness_of(patch.twist_stiffness);
    const double held =
        0.5 * (patch.tangential.squaredNorm() * soft_before + patch.torsion * patch.torsion * twist_soft_before);
    // E* sqrt(R*) = pi R* traction
    const double       root = std::cbrt(0.75 / std::numbers::pi * state.load / (law.effective_radius * law.traction));
    const double       arm_squared  = state.spread + 0.4 * law.effective_radius * root * root;
    const double       k_tangential = law.shear_ratio * state.stiffness;
    const double       k_twist      = k_tangential * arm_squared;
    const double       cap          = law.friction * state.load;
    const double       twist_cap    = 0.94 * cap * std::sqrt(arm_squared);
    const double       viscosity    = 2.0 * law.damping_ratio * std::sqrt(k_tangential * law.reduced_mass);
    const Vec3<double> sliding      = state.velocity - state.normal * state.normal.dot(state.velocity);

    Vec3<double> force   = turn_with_normal(patch.tangential, patch.normal, state.normal);
    double       torsion = patch.torsion;
    force                = turn_about(force, state.normal, state.common_spin * dt);
    if (state.stiffness < patch.stiffness) { force *= k_tangential * soft_before; }
    if (k_twist < patch.twist_stiffness) { torsion *= k_twist * twist_soft_before; }
    const double soft = softness_of(k_tangential), twist_soft = softness_of(k_twist);
    const auto   held_by = [&](const Vec3<double>& f, double m)
    { return 0.5 * (f.squaredNorm() * soft + m * m * twist_soft); };
    const double turned = held_by(force, torsion);

    force -= k_tangential * dt * sliding;
    torsion -= k_twist * dt * state.spin;
    const double length = force.norm(), twist = std::fabs(torsion);
    const double slid        = length > cap ? cap * (length - cap) * soft : 0.0;
    const double turned_past = twist > twist_cap ? twist_cap * (twist - twist_cap) * twist_soft : 0.0;
    force *= cap_factor(length, cap);
    torsion *= cap_factor(twist, twist_cap);

    Vec3<double> total        = force - viscosity * sliding;
    double       total_moment = torsion - viscosity * arm_squared * state.spin;
    total *= cap_factor(total.norm(), cap);
    total_moment *= cap_factor(std::fabs(total_moment), twist_cap);
    const double damped = -dt * ((total - force).dot(sliding) + (total_moment - torsion) * state.spin);

    patch = {force, state.normal, torsion, state.stiffness, k_twist};
    return {total, total_moment, held_by(force, torsion), held - turned + slid + turned_past + damped};
}

} // namespace tread::dem
