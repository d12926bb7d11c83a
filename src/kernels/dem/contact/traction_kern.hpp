#pragma once

#include <cmath>
#include <numbers>

#include "backend/vector.hpp"
#include "kernels/dem/templates.hpp"

// Constants of a pair and the traction p(d) between two rigid surfaces: docs/theory.md#traction. With d(r) = delta -
// r^2/(2 R*) its integral is Hertz's force 4/3 E* sqrt(R*) delta^1.5 (the paper's Eq. 14).
namespace tread::dem
{

struct PairLaw
{
    double effective_young;  ///< Pa, E* times the Hertz factor
    double effective_radius; ///< m, R*
    double traction;         ///< Pa/sqrt(m), E*/(pi sqrt(R*)): p = traction sqrt(d)
    double linear_overlap;   ///< m, d0: below it the traction is linear
    double linear_slope;     ///< Pa/m, slope of the linear part
    double shear_ratio;      ///< k_t/K = 4 G*/E*: Mindlin's 8 G* sqrt(R* d) where the patch is resolved
    double friction;         ///< Coulomb coefficient
    double damping_ratio;    ///< zeta, normal and tangential
    double reduced_mass;     ///< kg, m*; 0 if neither side can move
    double rolling_friction; ///< mu_r
};

/// Computes 1/sqrt(x): one operation on a GPU instead of a root and a division, which are both slow.
TREAD_HD double inverse_root(double x)
{
#if defined(__CUDA_ARCH__)
    return rsqrt(x);
#else
    return 1.0 / std::sqrt(x);
#endif
}

/// Makes the law of a pair. inverse_radii = 1/R_a + 1/R_b, inverse_masses = 1/m_a + 1/m_b.
TREAD_HD PairLaw pair_law(const PairProperties& pair, const ContactOptions& options, double inverse_radii,
                          double inverse_masses)
{
    const double radius   = 1.0 / inverse_radii;
    const double young    = options.hertz_factor * pair.effective_young;
    const double traction = young / std::numbers::pi * std::sqrt(inverse_radii);
    const double linear   = options.linear_overlap * radius;
    return {young,
            radius,
            traction,
            linear,
            traction * inverse_root(linear),
            4.0 * pair.effective_shear / pair.effective_young,
            pair.friction,
            pair.damping_ratio,
            inverse_masses > 0 ? 1.0 / inverse_masses : 0.0,
            pair.rolling_friction};
}

/// Traction p(d), Pa; slope p'(d), Pa/m; and the potential psi with psi' = p, J/m2.
struct Traction
{
    double pressure;
    double slope;
    double energy;
};

TREAD_HD Traction traction_at(const PairLaw& law, double overlap)
{
    const double knee = law.linear_overlap;
    if (overlap < knee)
    {
        return {law.linear_slope * overlap, law.linear_slope, 0.5 * law.linear_slope * overlap * overlap};
    }
    // psi of the linear part is d0^1.5/2 at d0, where that of the square root would be 2/3 d0^1.5
    const double slope = 0.5 * law.traction * inverse_root(overlap), pressure = 2.0 * overlap * slope;
    return {pressure, slope, 2.0 / 3.0 * overlap * pressure - law.linear_slope * knee * knee / 6.0};
}

} // namespace tread::dem
