#pragma once

#include "kernels/mpm/laws/elasticity.hpp"
#include "kernels/mpm/laws/objective_rate_kern.hpp"
#include "kernels/mpm/laws/stiffening_kern.hpp"

namespace tread::mpm
{

/// Computes C : strain for isotropic C, Pa; `strain` in tensor components.
template<class Real>
TREAD_HD Sym3<Real> elastic_stress(const Elasticity<Real>& elasticity, const Sym3<Real>& strain)
{
    Sym3<Real> stress   = Real(2) * elasticity.shear_modulus * strain;
    const Real pressure = elasticity.lame_modulus * (strain[0] + strain[1] + strain[2]);
    for (int i = 0; i < 3; ++i) { stress[i] += pressure; }
    return stress;
}

/// Computes the hypoelastic step R stress R^T + C : D dt with incremental objectivity (Hughes and Winget 1980).
template<class Real>
TREAD_HD Sym3<Real> trial_stress(const Elasticity<Real>& elasticity, const Sym3<Real>& stress,
                                 const Mat3<Real>& gradient, Real dt)
{
    const Sym3<Real> turned = rotation_of_stress(stress, rotation_increment(gradient, dt));
    return stress + (turned + elastic_stress(elasticity, strain_increment(gradient, dt)));
}

/// Computes a : C^-1 : b, J/m3: the work of stress `a` on the elastic strain of stress `b`.
template<class Real>
TREAD_HD Real elastic_product(const Elasticity<Real>& elasticity, const Sym3<Real>& a, const Sym3<Real>& b)
{
    const Real mean = (a[0] + a[1] + a[2]) * Real(1.0 / 3), other = (b[0] + b[1] + b[2]) * Real(1.0 / 3);
    Real       product = 0;
    for (int i = 0; i < 3; ++i) { product += (a[i] - mean) * (b[i] - other) + Real(2) * a[3 + i] * b[3 + i]; }
    return mean * other * elasticity.bulk_compliance + product * elasticity.shear_compliance;
}

/// Computes the recoverable energy of the stress, J/m3, without further state: p^2/(2K) + s:s/(4G) where stiffness
/// does not grow with pressure.
template<class Real>
TREAD_HD Real elastic_energy_density(const Elasticity<Real>& elasticity, const Sym3<Real>& stress)
{
    if (elasticity.stiff_pressure > 0) { return stiffening_energy(elasticity, stress); }
    return Real(0.5) * elastic_product(elasticity, stress, stress);
}

} // namespace tread::mpm
