#pragma once

#include "backend/vector.hpp"

// Functions of tangential contact springs, for contacts between bodies and between sand and bodies.
namespace tread::dem
{

/// Rotates `force` (tangential to the unit vector `from`) with the normal by the smallest rotation that takes `from` to
/// `to` (T. Moeller and J. Hughes, J. Graphics Tools 4(4), 1999). The force keeps its length and stays tangential; it
/// is cleared if the normal reverses.
TREAD_HD Vec3<double> turn_with_normal(const Vec3<double>& force, const Vec3<double>& from, const Vec3<double>& to)
{
    const double     cosine = from.dot(to);
    constexpr double flip   = -0.99;
    if (cosine < flip) { return Vec3<double>::Zero(); }
    const Vec3<double> axis = from.cross(to);
    return cosine * force + axis.cross(force) + axis * (axis.dot(force) / (1.0 + cosine));
}

/// Returns 1/stiffness; 0 for a spring without stiffness.
TREAD_HD double softness_of(double stiffness) { return stiffness > 0 ? 1.0 / stiffness : 0.0; }

/// Returns the energy (J) of a spring of this stiffness (N/m) at this force.
TREAD_HD double spring_energy(double squared_force, double stiffness)
{
    return 0.5 * squared_force * softness_of(stiffness);
}

} // namespace tread::dem
