#pragma once

#include "kernels/mpm/pages.hpp"

namespace tread::mpm
{

/// Weights of the 3 x 3 x 3 nodes around a point, one axis at a time.
/// Quadratic B-splines (Steffen, Kirby, Berzins 2008) or linear hats, whose third weight is zero.
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

template<class Real>
TREAD_HD void linear_weights(Real f, Real inverse_spacing, Real* weight, Real* slope)
{
    weight[0] = Real(1) - f;
    weight[1] = f;
    weight[2] = 0;
    slope[0]  = -inverse_spacing;
    slope[1]  = inverse_spacing;
    slope[2]  = 0;
}

/// Stencil of a position (m). `stencil_shift` 0.5 means quadratic, 0 linear.
template<class Real>
TREAD_HD Stencil<Real> stencil_at(const Vec3<double>& position, double spacing, double stencil_shift)
{
    Stencil<Real> stencil;
    stencil.base         = cell_of(position, spacing, stencil_shift);
    const double base[3] = {double(stencil.base.x), double(stencil.base.y), double(stencil.base.z)};
    const Real   inverse = static_cast<Real>(1 / spacing);
    for (int axis = 0; axis < 3; ++axis)
    {
        const Real f           = static_cast<Real>(position[axis] / spacing - base[axis]);
        stencil.fraction[axis] = f;
        if (stencil_shift > 0) { quadratic_weights(f, inverse, stencil.weight[axis], stencil.slope[axis]); }
        else { linear_weights(f, inverse, stencil.weight[axis], stencil.slope[axis]); }
    }
    return stencil;
}

/// Place in the page's tile of the stencil's lowest node.
TREAD_HD int tile_base(Index3 base) { return (base.x & 3) + tile_edge * ((base.y & 3) + tile_edge * (base.z & 3)); }

/// Place of node (i, j, k) of a stencil relative to its lowest.
TREAD_HD int tile_offset(int i, int j, int k) { return i + tile_edge * (j + tile_edge * k); }

} // namespace tread::mpm
