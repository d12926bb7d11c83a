#pragma once

#include "backend/vector.hpp"

namespace tread::mpm
{

/// Returns the correction of a velocity gradient L (1/s) from the positions at the start of a step to those at
/// mid-step: C = L (1 + L dt/2)^-1 - L = -L^2 dt/2 + O(dt^2). Points move along straight lines, f = 1 + L dt: in a
/// rotation by an angle a they move outwards by a^2/2, which L + C includes and L does not. Two terms of the series:
/// the error is a quarter of the cube of the step's strain, and a rotation strains by a^4/4.
template<class Real>
TREAD_HD Mat3<Real> to_mid_step(const Mat3<Real>& gradient, Real dt)
{
    return (Real(-0.5) * dt) * (gradient * gradient);
}

/// Trace of this correction.
template<class Real>
TREAD_HD Real divergence_to_mid_step(const Mat3<Real>& gradient, Real dt)
{
    const Real squares =
                   gradient(0, 0) * gradient(0, 0) + gradient(1, 1) * gradient(1, 1) + gradient(2, 2) * gradient(2, 2),
               products =
                   gradient(0, 1) * gradient(1, 0) + gradient(0, 2) * gradient(2, 0) + gradient(1, 2) * gradient(2, 1);
    return Real(-0.5) * dt * (squares + Real(2) * products);
}

} // namespace tread::mpm
