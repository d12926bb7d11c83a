#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/mpm/laws/elasticity.hpp"
#include "kernels/mpm/laws/plastic_state.hpp"
#include "kernels/mpm/laws/strength.hpp"
#include "kernels/mpm/laws/volume_gap_kern.hpp"

// Drucker-Prager perfect plasticity, tension positive, m the mean stress:
//   f = sqrt(J2) + eta m - k <= 0, flow along the gradient of the same with eta_flow <= eta.
// The return is exact: cone, apex (de Souza Neto, Peric, Owen 2008, Computational Methods for Plasticity, 8.3).
namespace tread::mpm
{

/// Intersection of the cone with the Mohr-Coulomb hexagon of the same friction angle and cohesion.
enum class ConeFit
{
    compression, ///< triaxial compression, the outer edges: too strong elsewhere
    extension,   ///< triaxial extension, the inner edges: too weak elsewhere
    plane_strain ///< plane-strain flow
};

template<class Real>
struct DruckerPrager
{
    Real slope;        ///< eta
    Real flow_slope;   ///< of the flow potential: volumetric plastic strain per multiplier
    Real limit;        ///< Pa, k: sqrt(J2) at zero pressure
    Real apex_tension; ///< Pa, see apex_tension(Strength)
};

/// Slope of the cone through the outer (`side` = -1) or inner (+1) edges of the hexagon.
inline double edge_slope(double sine, double side) { return 6 * sine / (std::numbers::sqrt3 * (3 + side * sine)); }

/// Makes the law, computed in fp64 and rounded to Real. The limit k of a cone is its slope times c cot phi except for
/// phi = 0; the slopes below are therefore divided by sin phi. In plane strain the out-of-plane flow vanishes,
/// s_y = -2/3 eta_flow sqrt(J2), which gives eta_flow = sin psi / sqrt(1 + sin^2 psi / 3) and eta = sin phi / (sqrt(1 -
/// eta_flow^2 / 3) + sin phi eta_flow / 3); for psi = phi that is 3 tan phi / sqrt(9 + 12 tan^2 phi) (Drucker and
/// Prager 1952).
template<class Real>
DruckerPrager<Real> make_drucker_prager(const Strength& strength, ConeFit fit)
{
    constexpr double radians  = std::numbers::pi / 180;
    const double     friction = strength.friction_angle_deg * radians;
    const double     sine = std::sin(friction), flow_sine = std::sin(strength.dilation_angle_deg * radians);
    const double     side    = fit == ConeFit::compression ? -1 : 1;
    double           flow    = edge_slope(flow_sine, side);
    double           divisor = std::numbers::sqrt3 * (3 + side * sine) / 6;
    if (fit == ConeFit::plane_strain)
    {
        flow    = flow_sine / std::sqrt(1 + flow_sine * flow_sine / 3);
        divisor = std::sqrt(1 - flow * flow / 3) + sine * flow / 3;
    }
    const double slope = sine / divisor, limit = strength.cohesion * std::cos(friction) / divisor;
    return {static_cast<Real>(slope), static_cast<Real>(flow), static_cast<Real>(limit),
            static_cast<Real>(apex_tension(strength))};
}

/// Returns sqrt(J2) on the cone at the mean stress m; negative beyond the apex.
template<class Real>
TREAD_HD Real cone_radius(const DruckerPrager<Real>& law, Real mean)
{
    return law.limit - law.slope * mean;
}

/// Returns stress and state for a trial stress (Pa) after the step dt (s). Separated grains cannot dilate: the flow is
/// isochoric while a gap is open.
template<class Real>
TREAD_HD StressUpdate<Real> respond(const Elasticity<Real>& elasticity, const DruckerPrager<Real>& law,
                                    const Sym3<Real>& trial, const PlasticState<Real>& state, Real dt)
{
    StressUpdate<Real> update{trial, {state.plastic_shear, Real(0), state.volume_gap}, Real(0)};
    Real               mean     = (trial[0] + trial[1] + trial[2]) * Real(1.0 / 3);
    const Real         closed   = close_gap(mean, elasticity.bulk_modulus, update.state.volume_gap);
    Sym3<Real>         deviator = trial;
    for (int i = 0; i < 3; ++i)
    {
        update.stress[i] += closed;
        deviator[i] -= mean;
    }
    mean += closed;
    Real j2 = 0;
    for (int i = 0; i < 3; ++i) { j2 += Real(0.5) * deviator[i] * deviator[i] + deviator[3 + i] * deviator[3 + i]; }
    const Real shear = elasticity.shear_modulus, bulk = elasticity.bulk_modulus;
    const Real radius = std::sqrt(j2), excess = radius - cone_radius(law, mean);
    const bool opens = beyond_apex(mean, law.apex_tension);
    if (!opens && excess <= yield_tolerance<Real> * (radius + law.slope * std::abs(mean) + law.limit))
    {
        return update;
    }

    const Real flow       = update.state.volume_gap > 0 ? Real(0) : law.flow_slope;
    const Real multiplier = excess / (shear + bulk * law.slope * flow);
    Real       new_mean = mean - multiplier * bulk * flow, new_radius = cone_radius(law, new_mean);
    const bool at_apex = new_radius < 0 || new_mean > law.apex_tension;
    if (at_apex)
    {
        new_mean   = law.apex_tension;
        new_radius = 0;
    }
    const Real scale = radius > 0 ? new_radius / radius : Real(0);
    update.stress    = scale * deviator;
    for (int i = 0; i < 3; ++i) { update.stress[i] += new_mean; }

    const Real drop = radius - new_radius, volume = (mean - new_mean) / bulk;
    const Real plastic_shear = drop / (Real(std::numbers::sqrt3) * shear); // e = s/(2 G), with s:s = 2 drop^2
    update.state.plastic_shear += plastic_shear;
    update.state.plastic_rate = plastic_shear / dt;
    if (at_apex && volume > 0) { update.state.volume_gap += volume; }
    update.plastic_work = new_mean * volume + new_radius * drop / shear;
    return update;
}

} // namespace tread::mpm
