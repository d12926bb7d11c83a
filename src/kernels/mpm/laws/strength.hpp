#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "backend/vector.hpp"

namespace tread::mpm
{

/// Strength of a granular material in the terms of Mohr and Coulomb, which every granular law takes its constants from:
/// 0 <= dilation <= friction < 90 degrees, cohesion >= 0.
struct Strength
{
    double friction_angle_deg;
    double dilation_angle_deg;
    double cohesion; ///< Pa
};

/// A stress above its yield limit by this share of its size is yielding: 16 roundings, above what an
/// eigen-decomposition and the yield function leave (2-3), so that a returned stress is not returned again.
template<class Real>
constexpr Real yield_tolerance = Real(16) * std::numeric_limits<Real>::epsilon();

/// Tension that no strength holds, Pa: c cot phi of the apex; none without cohesion, and no limit for phi = 0 < c.
inline double apex_tension(const Strength& strength)
{
    if (strength.cohesion == 0) { return 0; }
    const double friction = strength.friction_angle_deg * std::numbers::pi / 180;
    return friction > 0 ? strength.cohesion / std::tan(friction) : std::numeric_limits<double>::infinity();
}

/// The mean stress is beyond the apex. The yield surface sees to that itself but for phi = 0 = c, a liquid, which would
/// hold any tension (and made energy when it tore).
template<class Real>
TREAD_HD bool beyond_apex(Real mean, Real apex_tension)
{
    return mean - apex_tension > yield_tolerance<Real> * std::abs(mean);
}

} // namespace tread::mpm
