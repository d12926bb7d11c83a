#pragma once

#include <limits>

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

} // namespace tread::mpm
