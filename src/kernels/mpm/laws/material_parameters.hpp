#pragma once

#include <cstdint>

#include "kernels/mpm/laws/bolton_law_kern.hpp"
#include "kernels/mpm/laws/drucker_prager_cap_law_kern.hpp"
#include "kernels/mpm/laws/drucker_prager_law_kern.hpp"
#include "kernels/mpm/laws/elasticity.hpp"
#include "kernels/mpm/laws/mohr_coulomb_law_kern.hpp"

// Table of the constitutive laws. A law is a struct of constants and an item function
//   respond(elasticity, constants, trial stress, plastic state, dt) -> StressUpdate
// in a file of its own, and a row here.

/// ROW(name, Constants): LawKind::name, the member of MaterialParameters with the constants, make_material of them and
/// the case of update_stress (law_kern.hpp).
#define TREAD_LAWS(ROW)                                                                                                \
    ROW(mohr_coulomb, MohrCoulomb)                                                                                     \
    ROW(drucker_prager, DruckerPrager)                                                                                 \
    ROW(drucker_prager_cap, DruckerPragerCap)                                                                          \
    ROW(bolton, Bolton)

namespace tread::mpm
{

enum class LawKind : std::int32_t
{
    elastic,
#define TREAD_ROW(name, Constants) name,
    TREAD_LAWS(TREAD_ROW)
#undef TREAD_ROW
};

/// Parameters of a material for the laws, indexed by PointsView::material. Made on the host by make_material; the
/// constants of laws other than its own are zero.
template<class Real>
struct MaterialParameters : Elasticity<Real>
{
    LawKind law = LawKind::elastic;
#define TREAD_ROW(name, Constants) Constants<Real> name{};
    TREAD_LAWS(TREAD_ROW)
#undef TREAD_ROW
};

template<class Real>
MaterialParameters<Real> make_material(const Elasticity<Real>& elasticity)
{
    return {elasticity};
}

#define TREAD_ROW(name, Constants)                                                                                     \
    template<class Real>                                                                                               \
    MaterialParameters<Real> make_material(const Elasticity<Real>& elasticity, const Constants<Real>& law)             \
    {                                                                                                                  \
        MaterialParameters<Real> material{elasticity};                                                                 \
        material.law  = LawKind::name;                                                                                 \
        material.name = law;                                                                                           \
        return material;                                                                                               \
    }
TREAD_LAWS(TREAD_ROW)
#undef TREAD_ROW

} // namespace tread::mpm
