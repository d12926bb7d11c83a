#pragma once

#include <cmath>

namespace tread::mpm
{

/// Isotropic elastic constants of a material and derived quantities.
template<class Real>
struct Elasticity
{
    Real density;       ///< kg/m3
    Real lame_modulus;  ///< Pa, lambda
    Real shear_modulus; ///< Pa
    Real bulk_modulus;  ///< Pa
    Real wave_speed;    ///< m/s, of the fastest compression (P) wave at any pressure

    // Reciprocals, to avoid divisions in every step.
    Real bulk_compliance;  ///< 1/Pa, 1/K
    Real shear_compliance; ///< 1/Pa, 1/(2 G)

    Real stiff_pressure; ///< Pa, up to which stiffness grows (stiffening_kern.hpp); 0: one modulus for all pressures
};

/// Makes the constants from `young` > 0 in Pa, -1 < `poisson` < 0.5 and `density` > 0 in kg/m3; computed in fp64, then
/// rounded to Real. With a `stiff_pressure` > 0, Pa, they are those of the linear stress of stiffening_kern.hpp, half
/// as stiff.
template<class Real>
Elasticity<Real> make_elasticity(double young, double poisson, double density, double stiff_pressure = 0)
{
    const double part  = stiff_pressure > 0 ? 0.5 : 1;
    const double shear = part * young / (2 * (1 + poisson));
    const double lame  = part * young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    const double bulk  = lame + 2 * shear / 3;
    return {static_cast<Real>(density),
            static_cast<Real>(lame),
            static_cast<Real>(shear),
            static_cast<Real>(bulk),
            static_cast<Real>(std::sqrt((lame + 2 * shear) / (part * density))),
            static_cast<Real>(1 / bulk),
            static_cast<Real>(1 / (2 * shear)),
            static_cast<Real>(stiff_pressure)};
}

} // namespace tread::mpm
