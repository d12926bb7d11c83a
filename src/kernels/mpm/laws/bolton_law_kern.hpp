#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "backend/out_of_line.hpp"
#include "kernels/mpm/laws/mohr_coulomb_law_kern.hpp"
#include "kernels/mpm/laws/stiffening_kern.hpp"

// Mohr-Coulomb plasticity whose friction and dilation follow density and pressure by the relative dilatancy index of
// Bolton (1986, The strength and dilatancy of sands, Geotechnique 36(1), 65-78):
//   I_R = I_D (Q - ln(p / 1 kPa)) - R,   phi = phi_crit + a I_R,   -d eps_v / d eps_1 = 0.3 I_R,
// with I_D = (e_max - e) / (e_max - e_min) of the present void ratio e and a = 3 degrees in triaxial compression or 5
// in plane strain. Below 150 kPa p counts as 150 kPa (Bolton 1987, Geotechnique 37(2), 219-226), which with Q = 10 and
// R = 1 gives I_R = 5 I_D - 1. I_R = 0 is the critical state: denser sand is stronger, dilates and softens towards it,
// looser sand is weaker and contracts.
namespace tread::mpm
{

/// Constants of sand that knows its density.
template<class Real>
struct Bolton
{
    Real sin_critical; ///< of the friction angle of the critical state
    Real cos_critical;
    Real initial_density;    ///< I_D when the volume ratio is one
    Real density_per_strain; ///< loss of I_D per volumetric strain of the skeleton: (1 + e_0) / (e_max - e_min)
    Real grain_strength;     ///< Q
    Real offset;             ///< R
    Real friction_per_index; ///< radians, a
    Real cohesion;           ///< Pa
    Real nonlocal_weight;    ///< of the mean strain in the strain that the density follows; 0: the point's own alone
};

/// Density, grain and fit constants of Bolton's correlation.
struct DensityDependence
{
    double relative_density; ///< 0 to 1, at the start
    double void_ratio_min;
    double void_ratio_max;
    double grain_strength         = 10; ///< Q: 10 for quartz and feldspar, 8 for limestone, 5.5 for chalk
    double offset                 = 1;  ///< R
    double friction_per_index_deg = 3;  ///< 3 in triaxial compression, 5 in plane strain
    double nonlocal_weight        = 0;  ///< 0: a law without a length

    double initial_void_ratio() const { return void_ratio_max - relative_density * (void_ratio_max - void_ratio_min); }
};

/// Largest I_R of Bolton's data; the least is -R, of grains that hardly touch (I_D = 0).
inline constexpr double largest_dilatancy_index = 4;
inline constexpr double lowest_pressure         = 150; ///< kPa
inline constexpr double dilation_per_index      = 0.3;

/// Makes the law; `strength` has the friction angle of the critical state and the cohesion. Computed in fp64 and
/// rounded to Real.
template<class Real>
Bolton<Real> make_bolton(const Strength& strength, const DensityDependence& density)
{
    constexpr double radians  = std::numbers::pi / 180;
    const double     friction = strength.friction_angle_deg * radians;
    const double     range    = density.void_ratio_max - density.void_ratio_min;
    return {static_cast<Real>(std::sin(friction)),
            static_cast<Real>(std::cos(friction)),
            static_cast<Real>(density.relative_density),
            static_cast<Real>((1 + density.initial_void_ratio()) / range),
            static_cast<Real>(density.grain_strength),
            static_cast<Real>(density.offset),
            static_cast<Real>(density.friction_per_index_deg * radians),
            static_cast<Real>(strength.cohesion),
            static_cast<Real>(density.nonlocal_weight)};
}

/// Computes I_R at the volume ratio of the grain skeleton (gaps between separated grains excluded) and the mean stress
/// (Pa, tension positive).
template<class Real>
TREAD_HD Real dilatancy_index(const Bolton<Real>& law, Real skeleton_ratio, Real mean)
{
    const Real loss     = law.density_per_strain * (skeleton_ratio - Real(1));
    const Real density  = std::min(std::max(law.initial_density - loss, Real(0)), Real(1));
    const Real pressure = std::max(-mean * Real(1e-3), Real(lowest_pressure));
    const Real index    = density * (law.grain_strength - std::log(pressure)) - law.offset;
    return std::min(std::max(index, -law.offset), Real(largest_dilatancy_index));
}

/// Mohr-Coulomb constants at the index I_R. The dilation angle gives the rate of volume 0.3 I_R in triaxial compression
/// and in plane strain alike: sin psi = D / (2 + D).
template<class Real>
TREAD_HD MohrCoulomb<Real> strength_at(const Bolton<Real>& law, Real index)
{
    const Real more = law.friction_per_index * index, rate = Real(dilation_per_index) * index;
    const Real sine   = law.sin_critical * std::cos(more) + law.cos_critical * std::sin(more);
    const Real cosine = law.cos_critical * std::cos(more) - law.sin_critical * std::sin(more);
    return {sine, cosine, rate / (Real(2) + rate), law.cohesion,
            law.cohesion > 0 ? law.cohesion * cosine / sine : Real(0)};
}

/// Computes the volume ratio of the skeleton whose density the law sees. Of the log volume ratio it takes m times the
/// mean over the surroundings and 1 - m times the point's own (over-nonlocal softening: Vermeer and Brinkgreve 1994;
/// docs/theory.md#softening-length).
template<class Real>
TREAD_HD Real seen_skeleton(const Bolton<Real>& law, const PlasticState<Real>& state)
{
    const Real own = state.volume_ratio * std::exp(-state.volume_gap);
    if (law.nonlocal_weight == 0) { return own; }
    return own * std::exp(law.nonlocal_weight * (state.mean_strain - std::log(own)));
}

/// Returns stress and state for a trial stress (Pa; the linear one of stiffening_kern.hpp) after the step dt (s), with
/// the strength of the density before the step. Grains that cohesion holds in tension do not contract in shear:
/// contraction against a tension would make energy.
template<class Real>
TREAD_HD_OUT_OF_LINE StressUpdate<Real> respond(const Elasticity<Real>& elasticity, const Bolton<Real>& law,
                                                const Sym3<Real>& trial, const PlasticState<Real>& state, Real dt)
{
    const Real         mean = (trial[0] + trial[1] + trial[2]) * Real(1.0 / 3) * acting_over_linear(elasticity, trial);
    MohrCoulomb<Real>  strength = strength_at(law, dilatancy_index(law, seen_skeleton(law, state), mean));
    StressUpdate<Real> update   = respond(elasticity, strength, trial, state, dt);
    if (update.plastic_work < 0)
    {
        strength.sin_dilation = 0;
        update                = respond(elasticity, strength, trial, state, dt);
    }
    return update;
}

} // namespace tread::mpm
