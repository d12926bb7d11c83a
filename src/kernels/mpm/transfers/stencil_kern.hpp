#pragma once

#include <cmath>

#include "kernels/mpm/pages/pages.hpp"

namespace tread::mpm
{

/// Weights of the 3 x 3 x 3 nodes around a point, one axis at a time. Quadratic B-splines (Steffen, Kirby, Berzins
/// 2008) or linear hats, whose third weight is zero.
template<class Real>
struct Stencil
{
    Index3 base;         ///< lowest node
    Real   fraction[3];  ///< of the point above the base, in spacings
    Real   weight[3][3]; ///< [axis][node]
    Real   slope[3][3];  ///< 1/m
};

template<class Real>
TREAD_HD void quadratic_weights(Real f, Real inverse_spacing, Real* weight, Real* slope)
{
    const Real low = Real(1.5) - f, high = f - Real(0.5), middle = f - Real(1);
    weight[0] = Real(0.5) * low * low;
    weight[1] = Real(0.75) - middle * middle;
    weight[2] = Real(0.5) * high * high;
    slope[0]  = -low * inverse_spacing;
    slope[1]  = Real(-2) * middle * inverse_spacing;
    slope[2]  = high * inverse_spacing;
}

/// Computes the weights of linear hats. A point on a node plane counts as a millionth of a spacing above it: the next
/// node has a slope there, and with zero weight it would have no velocity either (with 10 m/s through cells this caused
/// stresses of 0.03 E).
template<class Real>
TREAD_HD void linear_weights(Real f, Real inverse_spacing, Real* weight, Real* slope)
{
    const Real least = Real(1e-6), share = f > least ? f : least;
    weight[0] = Real(1) - share;
    weight[1] = share;
    weight[2] = 0;
    slope[0]  = -inverse_spacing;
    slope[1]  = inverse_spacing;
    slope[2]  = 0;
}

/// Computes the weights along one axis of a point `f` spacings above its lowest node.
template<class Real>
TREAD_HD void axis_weights(Real f, Real inverse_spacing, double stencil_shift, Real* weight, Real* slope)
{
    if (stencil_shift > 0) { quadratic_weights(f, inverse_spacing, weight, slope); }
    else { linear_weights(f, inverse_spacing, weight, slope); }
}

/// Makes the stencil of a position (m) whose lowest node is `base`. `slope_scale`: 1/m, or 1 for slopes per spacing.
template<class Real>
TREAD_HD Stencil<Real> stencil_above(Index3 base, const Vec3<double>& position, double slope_scale,
                                     const Lattice& lattice)
{
    Stencil<Real> stencil;
    stencil.base          = base;
    const double shift    = lattice.node_shift;
    const double lowest[] = {base.x + shift, base.y + shift, base.z + shift};
    for (int axis = 0; axis < 3; ++axis)
    {
        stencil.fraction[axis] = static_cast<Real>(position[axis] * lattice.inverse_spacing - lowest[axis]);
        axis_weights(stencil.fraction[axis], static_cast<Real>(slope_scale), lattice.stencil_shift,
                     stencil.weight[axis], stencil.slope[axis]);
    }
    return stencil;
}

/// Computes sum += factor * value for each element of an array or vector, with one rounding on both backends.
template<class Real, class Numbers>
TREAD_HD void add_scaled(Real factor, const Numbers& value, Numbers& sum)
{
    constexpr int count = sizeof(Numbers) / sizeof(Real);
    for (int i = 0; i < count; ++i) { sum[i] = std::fma(factor, value[i], sum[i]); }
}

/// Index in the page's tile of the stencil's lowest node.
TREAD_HD int tile_base(Index3 base) { return (base.x & 3) + tile_edge * ((base.y & 3) + tile_edge * (base.z & 3)); }

/// Index of node (i, j, k) of a stencil relative to its lowest node.
TREAD_HD int tile_offset(int i, int j, int k) { return i + tile_edge * (j + tile_edge * k); }

} // namespace tread::mpm
