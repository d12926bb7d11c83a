#pragma once

#include "kernels/mpm/laws/elastic_law_kern.hpp"
#include "kernels/mpm/laws/material_parameters.hpp"

namespace tread::mpm
{

/// Updates a point's stress by its law. `stress` Pa, Kirchhoff, world axes; `gradient` 1/s, [i][j] = d v_i / d x_j, at
/// mid-step; dt s. An elastic material returns `state` unchanged.
template<class Real>
TREAD_HD StressUpdate<Real> update_stress(const MaterialParameters<Real>& material, const Sym3<Real>& stress,
                                          const PlasticState<Real>& state, const Mat3<Real>& gradient, Real dt)
{
    // Laws see the linear stress (stiffening_kern.hpp).
    const Real         linear = linear_over_acting<Real>(material, stress);
    const Sym3<Real>   trial  = trial_stress<Real>(material, linear * stress, gradient, dt);
    StressUpdate<Real> update{trial, state, Real(0)};
    switch (material.law)
    {
// A copy for each: what a law out of line takes by reference lies in memory, and would for every other law.
#define TREAD_ROW(name, Constants)                                                                                     \
    case LawKind::name:                                                                                                \
    {                                                                                                                  \
        const StressUpdate<Real> elastic{trial, state, Real(0)};                                                       \
        update = respond(material, material.name, elastic.stress, elastic.state, dt);                                  \
        break;                                                                                                         \
    }
        TREAD_LAWS(TREAD_ROW)
#undef TREAD_ROW
    case LawKind::elastic:
        return update;
    }
    const Sym3<Real> drop   = trial - update.stress;
    const Real       acting = acting_over_linear<Real>(material, update.stress);
    update.stress *= acting;
    if (drop.squaredNorm() == 0) { return update; }
    update.plastic_work *= acting;
    const Sym3<Real> turned = (trial - elastic_stress<Real>(material, strain_increment(gradient, dt))) / linear;
    update.work_to_mean     = Real(-0.5) * elastic_product<Real>(material, drop, update.stress - turned);
    return update;
}

} // namespace tread::mpm
