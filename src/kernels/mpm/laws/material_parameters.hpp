#pragma once

#include <cstdint>

#include "kernels/mpm/laws/drucker_prager_law_kern.hpp"
#include "kernels/mpm/laws/elasticity.hpp"
#include "kernels/mpm/laws/mohr_coulomb_law_kern.hpp"

// Table of the constitutive laws. A law is a struct of constants and an item function
//   respond(elasticity, constants, trial stress, plastic state, dt) -> StressUpdate
// in a file of its own; it is registered here by a name and a member for its constants, and by a line in update_stress
// (law_kern.hpp).
namespace tread::mpm
{

enum class LawKind : std::int32_t
{
    elastic,
    mohr_coulomb,
    drucker_prager
};

/// Parameters of a material for the laws, indexed by PointsView::material. Made on the host by make_material; the
/// constants of laws other than its own are zero.
template<class Real>
struct MaterialParameters : Elasticity<Real>
{
    LawKind             law = LawKind::elastic;
    MohrCoulomb<Real>   mohr_coulomb{};
    DruckerPrager<Real> drucker_prager{};
};

template<class Real>
MaterialParameters<Real> make_material(const Elasticity<Real>& elasticity)
{
    return {elasticity, LawKind::elastic, {}, {}};
}

template<class Real>
MaterialParameters<Real> make_material(const Elasticity<Real>& elasticity, const MohrCoulomb<Real>& law)
{
    return {elasticity, LawKind::mohr_coulomb, law, {}};
}

template<class Real>
MaterialParameters<Real> make_material(const Elasticity<Real>& elasticity, const DruckerPrager<Real>& law)
{
    return {elasticity, LawKind::drucker_prager, {}, law};
}

} // namespace tread::mpm
