#pragma once

#include "backend/out_of_line.hpp"
#include "kernels/mpm/laws/drucker_prager_law_kern.hpp"

// Drucker-Prager with a compression cap that hardens (Drucker, Gibson, Henkel 1957, Trans. ASCE 122:338; planar cap and
// corner with Koiter's flow). With the pressure p = -m:
//   cone  f = sqrt(J2) - eta p - k <= 0, flow as in drucker_prager_law_kern.hpp,
//   cap   p <= p_c, flow along p: the cap's plastic strain is compaction alone.
// The cap hardens by its own compaction e, dp_c / p_c = de / index (Butterfield 1979, Geotechnique 29:469), and never
// softens. As p = p_c whenever the cap flows, the returns below are exact for the whole step.
namespace tread::mpm
{

template<class Real>
struct DruckerPragerCap
{
    DruckerPrager<Real> cone;
    Real                cap_pressure; ///< Pa, p_c of sand that was never loaded
    Real                cap_index;    ///< log volume strain of compaction per e-fold of p_c
};

/// Makes the law: cap_pressure in Pa and cap_index, both above 0.
template<class Real>
DruckerPragerCap<Real> make_drucker_prager_cap(const Strength& strength, ConeFit fit, double cap_pressure,
                                               double cap_index)
{
    return {make_drucker_prager<Real>(strength, fit), static_cast<Real>(cap_pressure), static_cast<Real>(cap_index)};
}

/// Solves slope p + stiffness ln(p / cap) = target for p >= cap, where the left side is below the target at the cap. It
/// is concave, so that Newton's method from the cap rises monotonically and never passes the solution: wherever it
/// stops, the cap holds.
template<class Real>
TREAD_HD Real pressure_on_cap(Real cap, Real slope, Real stiffness, Real target)
{
    constexpr int most_iterations = 40;
    Real          pressure        = cap;
    for (int i = 0; i < most_iterations; ++i)
    {
        const Real missing = target - slope * pressure - stiffness * std::log(pressure / cap);
        const Real rise    = missing / (slope + stiffness / pressure);
        if (!(rise > Real(0.25) * yield_tolerance<Real> * pressure)) { break; }
        pressure += rise;
    }
    return pressure;
}

/// Returns stress and state for a trial stress (Pa) after the step dt (s). The first step of a point
/// (state.cap_pressure = 0) is elastic at the cap: sand starts normally consolidated under the stress it has, at least
/// at the law's cap_pressure.
template<class Real>
TREAD_HD_OUT_OF_LINE StressUpdate<Real> respond(const Elasticity<Real>& elasticity, const DruckerPragerCap<Real>& law,
                                                const Sym3<Real>& trial, const PlasticState<Real>& state, Real dt)
{
    StressUpdate<Real> update   = respond(elasticity, law.cone, trial, state, dt);
    const Real         pressure = -(update.stress[0] + update.stress[1] + update.stress[2]) * Real(1.0 / 3);
    const bool         virgin   = !(state.cap_pressure > 0);
    const Real         start    = virgin && pressure > law.cap_pressure ? pressure : law.cap_pressure;
    const Real         cap      = virgin ? start : state.cap_pressure;
    update.state.cap_pressure   = cap;
    if (!(pressure - cap > yield_tolerance<Real> * cap)) { return update; }

    // The cap flows. Under pressure no gap is left open.
    const Real shear = elasticity.shear_modulus, bulk = elasticity.bulk_modulus;
    const Real mean     = (trial[0] + trial[1] + trial[2]) * Real(1.0 / 3);
    const Real wanted   = -(mean + bulk * state.volume_gap);
    Sym3<Real> deviator = trial;
    for (int i = 0; i < 3; ++i) { deviator[i] -= mean; }
    Real j2 = 0;
    for (int i = 0; i < 3; ++i) { j2 += Real(0.5) * deviator[i] * deviator[i] + deviator[3 + i] * deviator[3 + i]; }
    const Real radius = std::sqrt(j2), stiffness = bulk * law.cap_index;

    Real new_pressure = wanted > cap ? pressure_on_cap(cap, Real(1), stiffness, wanted) : wanted;
    Real new_radius   = radius;
    if (radius > cone_radius(law.cone, -new_pressure))
    {
        const Real dilation = bulk * law.cone.flow_slope / shear;
        new_pressure        = pressure_on_cap(cap, Real(1) + dilation * law.cone.slope, stiffness,
                                              wanted + dilation * (radius - law.cone.limit));
        const Real cone     = cone_radius(law.cone, -new_pressure);
        new_radius          = cone < radius ? cone : radius;
    }
    update.stress = (radius > 0 ? new_radius / radius : Real(0)) * deviator;
    for (int i = 0; i < 3; ++i) { update.stress[i] -= new_pressure; }

    const Real drop = radius - new_radius, compaction = (wanted - new_pressure) / bulk;
    const Real plastic_shear   = drop / (Real(std::numbers::sqrt3) * shear);
    update.state.plastic_shear = state.plastic_shear + plastic_shear;
    update.state.plastic_rate  = plastic_shear / dt;
    update.state.volume_gap    = 0;
    update.state.cap_pressure  = new_pressure > cap ? new_pressure : cap;
    update.plastic_work        = new_pressure * compaction + new_radius * drop / shear;
    return update;
}

} // namespace tread::mpm
