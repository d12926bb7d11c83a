#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/mpm/laws/elasticity.hpp"
#include "kernels/mpm/laws/plastic_state.hpp"
#include "kernels/mpm/laws/strength.hpp"
#include "kernels/mpm/laws/symmetric_eigen_kern.hpp"
#include "kernels/mpm/laws/volume_gap_kern.hpp"

// Mohr-Coulomb perfect plasticity, tension positive, principal stresses s1 >= s2 >= s3:
//   f = (1 + sin phi) s1 - (1 - sin phi) s3 - 2 c cos phi <= 0, flow along the gradient of the same with psi <= phi.
// The return is exact: plane, two edges, apex (de Souza Neto, Peric, Owen 2008, Computational Methods for
// Plasticity, 8.2).
namespace tread::mpm
{

template<class Real>
struct MohrCoulomb
{
    Real sin_friction;
    Real cos_friction;
    Real sin_dilation;
    Real cohesion;     ///< Pa
    Real apex_tension; ///< Pa, see apex_tension(Strength)
};

/// Makes the law, computed in fp64 and rounded to Real.
template<class Real>
MohrCoulomb<Real> make_mohr_coulomb(const Strength& strength)
{
    constexpr double radians  = std::numbers::pi / 180;
    const double     friction = strength.friction_angle_deg * radians;
    return {static_cast<Real>(std::sin(friction)), static_cast<Real>(std::cos(friction)),
            static_cast<Real>(std::sin(strength.dilation_angle_deg * radians)), static_cast<Real>(strength.cohesion),
            static_cast<Real>(apex_tension(strength))};
}

template<class Real>
TREAD_HD Real yield_function(const MohrCoulomb<Real>& law, Real major, Real minor)
{
    return (Real(1) + law.sin_friction) * major - (Real(1) - law.sin_friction) * minor -
           Real(2) * law.cohesion * law.cos_friction;
}

/// Returns true only if the state is elastic, from invariants alone: over all Lode angles f is at most 2 sqrt(J2 (1 +
/// sin^2 phi / 3)) + 2 p sin phi - 2 c cos phi, the cone inscribed in the hexagon.
template<class Real>
TREAD_HD bool inside_inscribed_cone(const MohrCoulomb<Real>& law, Real mean, Real j2)
{
    const Real s     = law.sin_friction;
    const Real limit = law.cohesion * law.cos_friction - mean * s;
    return limit >= 0 && j2 * (Real(1) + s * s * Real(1.0 / 3)) <= limit * limit;
}

/// Returns true only if the state is elastic, from approximate principal values, which are cheaper than the axes.
template<class Real>
TREAD_HD bool surely_inside(const MohrCoulomb<Real>& law, const PrincipalRange<Real>& range)
{
    return yield_function(law, range.major + range.error, range.minor - range.error) < 0;
}

/// Largest and smallest principal stress on the yield surface, Pa.
template<class Real>
struct YieldPair
{
    Real major, minor;
    Real multiplier; ///< distance along the flow, in units of its rates
};

/// Intersects the yield surface with a flow that lowers (major, minor) at the rates (major_flow, minor_flow). Divides
/// by the larger coefficient of f, so that f vanishes to rounding whatever the distance.
template<class Real>
TREAD_HD YieldPair<Real> flow_to_surface(const MohrCoulomb<Real>& law, Real major, Real minor, Real major_flow,
                                         Real minor_flow)
{
    const Real steep = Real(1) + law.sin_friction, flat = Real(1) - law.sin_friction;
    const Real multiplier = yield_function(law, major, minor) / (steep * major_flow - flat * minor_flow);
    const Real returned   = minor - multiplier * minor_flow;
    return {(Real(2) * law.cohesion * law.cos_friction + flat * returned) / steep, returned, multiplier};
}

/// Returns ordered principal stresses for yielding trial values in order. On an edge both active surfaces share one
/// principal value and the equal pair moves as its mean, so that one multiplier remains.
template<class Real>
TREAD_HD Vec3<Real> return_principal(const Elasticity<Real>& elasticity, const MohrCoulomb<Real>& law,
                                     Real sin_dilation, const Vec3<Real>& trial)
{
    const Real shear = elasticity.shear_modulus, volume = Real(2) * elasticity.lame_modulus * sin_dilation;
    const Real up = Real(1) + sin_dilation, down = Real(1) - sin_dilation;
    const Real major_flow = volume + Real(2) * shear * up, minor_flow = volume - Real(2) * shear * down;

    const YieldPair<Real> plane  = flow_to_surface(law, trial[0], trial[2], major_flow, minor_flow);
    const Real            middle = trial[1] - plane.multiplier * volume;
    if (plane.major >= middle && middle >= plane.minor) { return {plane.major, middle, plane.minor}; }

    const bool            right = down * trial[0] - Real(2) * trial[1] + up * trial[2] > 0; // s2 = s3, else s1 = s2
    const Real            pair  = Real(0.5) * (trial[1] + (right ? trial[2] : trial[0]));
    const YieldPair<Real> edge  = right ? flow_to_surface(law, trial[0], pair, major_flow, volume - shear * down)
                                        : flow_to_surface(law, pair, trial[2], volume + shear * up, minor_flow);
    if (edge.major < edge.minor) { return Vec3<Real>::Constant(law.apex_tension); }
    return {edge.major, right ? edge.minor : edge.major, edge.minor};
}

/// Plastic flow of a return from `trial` to `stress`, in principal values.
template<class Real>
struct PlasticFlow
{
    Real shear;  ///< sqrt(2/3 e:e), deviatoric plastic strain
    Real volume; ///< volumetric plastic strain
    Real work;   ///< J/m3, stress : plastic strain
};

template<class Real>
TREAD_HD PlasticFlow<Real> plastic_flow(const Elasticity<Real>& elasticity, const Vec3<Real>& trial,
                                        const Vec3<Real>& stress)
{
    const Vec3<Real> drop        = trial - stress;
    const Real       mean        = drop.sum() * Real(1.0 / 3);
    const Vec3<Real> e           = (drop.array() - mean) * elasticity.shear_compliance;
    const Real       volume      = mean * elasticity.bulk_compliance;
    const Real       stress_mean = stress.sum() * Real(1.0 / 3);
    return {std::sqrt(Real(2.0 / 3) * e.squaredNorm()), volume,
            stress_mean * volume + e.dot(Vec3<Real>(stress.array() - stress_mean))};
}

/// Returns stress and state for a trial stress (Pa) after the step dt (s). Separated grains cannot dilate: the flow is
/// isochoric while a gap is open.
template<class Real>
TREAD_HD StressUpdate<Real> respond(const Elasticity<Real>& elasticity, const MohrCoulomb<Real>& law,
                                    const Sym3<Real>& trial, const PlasticState<Real>& state, Real dt)
{
    StressUpdate<Real> update{trial, {state.plastic_shear, Real(0), state.volume_gap}, Real(0)};
    Deviator<Real>     deviator = deviator_of(trial);
    const Real         closed   = close_gap(deviator.mean, elasticity.bulk_modulus, update.state.volume_gap);
    deviator.mean += closed;
    for (int i = 0; i < 3; ++i) { update.stress[i] += closed; }
    const bool opens = beyond_apex(deviator.mean, law.apex_tension);
    if (!opens && inside_inscribed_cone(law, deviator.mean, deviator.j2)) { return update; }
    const IsolatedValue<Real> isolated = isolated_value(deviator);
    if (!opens && surely_inside(law, principal_range(deviator.mean, isolated))) { return update; }

    const SymmetricEigen<Real> eigen = symmetric_eigen(deviator.mean, isolated);
    const Real                 major = eigen.values[0], minor = eigen.values[2];
    if (!opens &&
        yield_function(law, major, minor) <= yield_tolerance<Real> * (std::abs(major) + std::abs(minor) + law.cohesion))
    {
        return update;
    }
    const Real sin_dilation = update.state.volume_gap > 0 ? Real(0) : law.sin_dilation;
    Vec3<Real> returned     = return_principal(elasticity, law, sin_dilation, eigen.values);
    if (returned[2] > law.apex_tension) { returned.setConstant(law.apex_tension); }
    const PlasticFlow<Real> flow = plastic_flow(elasticity, eigen.values, returned);
    update.stress                = from_principal(returned, eigen.axes);
    update.state.plastic_shear += flow.shear;
    update.state.plastic_rate = flow.shear / dt;
    const bool at_apex        = returned[0] == law.apex_tension;
    if (at_apex && flow.volume > 0) { update.state.volume_gap += flow.volume; }
    update.plastic_work = flow.work;
    return update;
}

} // namespace tread::mpm
