#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "backend/vector.hpp"

namespace tread::mpm
{

/// Mohr-Coulomb strength of a granular material, from which every granular law derives its constants: 0 <= dilation <=
/// friction < 90 degrees, cohesion >= 0.
struct Strength
{
    double friction_angle_deg;
    double dilation_angle_deg;
    double cohesion; ///< Pa
};

/// Relative tolerance of yielding: a stress above its yield limit by this share of its magnitude yields. It is 16
/// roundings, above the error of an eigen-decomposition and the yield function (2-3), so that a returned stress does
/// not yield again.
template<class Real>
constexpr Real yield_tolerance = Real(16) * std::numeric_limits<Real>::epsilon();

/// Maximum tension that the material carries, Pa: c cot phi of the apex; 0 without cohesion, no limit for phi = 0 < c.
inline double apex_tension(const Strength& strength)
{
    if (strength.cohesion == 0) { return 0; }
    const double friction = strength.friction_angle_deg * std::numbers::pi / 180;
    return friction > 0 ? strength.cohesion / std::tan(friction) : std::numeric_limits<double>::infinity();
}

/// Whether the mean stress is beyond the apex. The yield surface ensures this itself except for phi = 0 = c, a liquid,
/// which would carry any tension (and create energy when it separates).
template<class Real>
TREAD_HD bool beyond_apex(Real mean, Real apex_tension)
{
    return mean - apex_tension > yield_tolerance<Real> * std::abs(mean);
}

} // namespace tread::mpm
