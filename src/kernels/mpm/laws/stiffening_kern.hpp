#pragma once

#include <cmath>

#include "backend/vector.hpp"
#include "kernels/mpm/laws/elasticity.hpp"

// Stiffness that grows with the root of pressure and has a stored energy, the power 1/2 of Houlsby, Amorosi and Rojas
// (2005, Elastic moduli of soils dependent on pressure: a hyperelastic formulation, Geotechnique 55(5), 383-392). With
// t = C : elastic strain, the linear stress, and its size |t| = sqrt(mean^2 + K/(2G) s:s),
//   stress = h(x)/x t,   x = |t|/p_s,   h = x^2 up to x = 1 and its tangent 2x - 1 above.
// Both are parallel: strength without cohesion, whose yield surface is a cone, and its flow are the same in both, so
// that laws take t for stress. Tangents are 2 C x along t and C x across it, at most 2 C, which is that of young and
// poisson (make_elasticity).
namespace tread::mpm
{

/// Size |t| of the linear stress over the pressure p_s, or that of a stress that acts.
template<class Real>
TREAD_HD Real relative_size(const Elasticity<Real>& elasticity, const Sym3<Real>& stress)
{
    const Real mean   = (stress[0] + stress[1] + stress[2]) * Real(1.0 / 3);
    Real       square = 0;
    for (int i = 0; i < 3; ++i)
    {
        square += (stress[i] - mean) * (stress[i] - mean) + Real(2) * stress[3 + i] * stress[3 + i];
    }
    return std::sqrt(mean * mean + elasticity.bulk_modulus * elasticity.shear_compliance * square) /
           elasticity.stiff_pressure;
}

/// Computes the linear stress over the stress that acts.
template<class Real>
TREAD_HD Real linear_over_acting(const Elasticity<Real>& elasticity, const Sym3<Real>& acting)
{
    if (elasticity.stiff_pressure == 0) { return 1; }
    const Real size = relative_size(elasticity, acting);
    if (size == 0) { return 1; }
    return size < 1 ? Real(1) / std::sqrt(size) : Real(0.5) * (size + Real(1)) / size;
}

/// Computes the stress that acts over the linear stress.
template<class Real>
TREAD_HD Real acting_over_linear(const Elasticity<Real>& elasticity, const Sym3<Real>& linear)
{
    if (elasticity.stiff_pressure == 0) { return 1; }
    const Real size = relative_size(elasticity, linear);
    return size < 1 ? size : Real(2) - Real(1) / size;
}

/// Computes the recoverable energy of a stress that acts, J/m3, p_s^2/K times the integral of h.
template<class Real>
TREAD_HD Real stiffening_energy(const Elasticity<Real>& elasticity, const Sym3<Real>& acting)
{
    const Real size     = relative_size(elasticity, acting);
    const Real x        = size < 1 ? std::sqrt(size) : Real(0.5) * (size + Real(1));
    const Real integral = size < 1 ? size * x * Real(1.0 / 3) : x * x - x + Real(1.0 / 3);
    return elasticity.stiff_pressure * elasticity.stiff_pressure * elasticity.bulk_compliance * integral;
}

} // namespace tread::mpm
