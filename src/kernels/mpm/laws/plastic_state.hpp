#pragma once

#include "backend/vector.hpp"

namespace tread::mpm
{

/// Internal variables of a plastic point besides its stress.
template<class Real>
struct PlasticState
{
    Real
        plastic_shear; ///< sum of sqrt(2/3 e:e), e = deviatoric plastic strain increment (gamma/sqrt 3 in simple shear)
    Real plastic_rate; ///< 1/s, rate of plastic_shear in the last step
    Real volume_gap;   ///< log volume opened at the apex that must close before compression, >= 0
    Real volume_ratio = 1; ///< volume over initial volume before the step; no law changes it
    Real cap_pressure = 0; ///< Pa, pressure at which the cap of a capped law flows; 0 before the first step
    Real mean_strain  = 0; ///< mean of the skeleton's log volume ratio over the surroundings; no law changes it
};

/// State of a point after a step of its law.
template<class Real>
struct StressUpdate
{
    Sym3<Real>         stress; ///< Pa, Kirchhoff, tension positive
    PlasticState<Real> state;
    Real               plastic_work; ///< J/m3 of initial volume, of the step, at the returned stress: never negative
    /// J/m3, correction to the work at the mean of the stresses before and after. With it, plastic and elastic work
    /// together are the trapezoidal rule of the stress power.
    Real work_to_mean = 0;
};

} // namespace tread::mpm
