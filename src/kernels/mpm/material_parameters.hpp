#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace tread::mpm
{

enum class LawKind : std::int32_t
{
    elastic,
    mohr_coulomb
};

/// What the laws need of a material, by PointsView::material. Made on the host by make_parameters.
template<class Real>
struct MaterialParameters
{
    LawKind model;
    Real    density;       ///< kg/m3
    Real    lame_modulus;  ///< Pa, lambda
    Real    shear_modulus; ///< Pa
    Real    bulk_modulus;  ///< Pa
    Real    wave_speed;    ///< m/s, of compression waves
    Real    sin_friction;
    Real    cos_friction;
    Real    sin_dilation;
    Real    cohesion;     ///< Pa
    Real    apex_tension; ///< Pa, c cot phi; infinite for phi = 0, whose yield surface is a prism
};

/// `young` > 0 and `cohesion` >= 0 in Pa, -1 < `poisson` < 0.5, `density` > 0 in kg/m3,
/// 0 <= `dilation_angle_deg` <= `friction_angle_deg` < 90. Elastic materials ignore the last three. Computed in fp64,
/// then rounded to Real.
template<class Real>
MaterialParameters<Real> make_parameters(double young, double poisson, double density, double friction_angle_deg,
                                         double dilation_angle_deg, double cohesion, LawKind model)
{
    constexpr double radians  = std::numbers::pi / 180;
    const double     friction = friction_angle_deg * radians;
    const double     shear    = young / (2 * (1 + poisson));
    const double     lame     = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    const double     apex     = friction > 0 ? cohesion / std::tan(friction) : std::numeric_limits<double>::infinity();
    return {model,
            static_cast<Real>(density),
            static_cast<Real>(lame),
            static_cast<Real>(shear),
            static_cast<Real>(lame + 2 * shear / 3),
            static_cast<Real>(std::sqrt((lame + 2 * shear) / density)),
            static_cast<Real>(std::sin(friction)),
            static_cast<Real>(std::cos(friction)),
            static_cast<Real>(std::sin(dilation_angle_deg * radians)),
            static_cast<Real>(cohesion),
            static_cast<Real>(apex)};
}

} // namespace tread::mpm
