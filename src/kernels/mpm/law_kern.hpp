#pragma once

#include "kernels/mpm/elastic_law_kern.hpp"
#include "kernels/mpm/material_parameters.hpp"

namespace tread::mpm
{

/// One step of a point's law. `stress` Pa, Cauchy, world axes; `gradient` 1/s, [i][j] = d v_i / d x_j, of the middle of
/// the step; dt s. An elastic material hands `state` back as it came.
template<class Real>
TREAD_HD StressUpdate<Real> update_stress(const MaterialParameters<Real>& material, const Sym3<Real>& stress,
                                          const PlasticState<Real>& state, const Mat3<Real>& gradient, Real dt)
{
    const Sym3<Real> trial = trial_stress(material, stress, gradient, dt);
    switch (material.law)
    {
    case LawKind::mohr_coulomb:
        return respond(material, material.mohr_coulomb, trial, state, dt);
    case LawKind::drucker_prager:
        return respond(material, material.drucker_prager, trial, state, dt);
    case LawKind::elastic:
        break;
    }
    return {trial, state, Real(0)};
}

} // namespace tread::mpm
