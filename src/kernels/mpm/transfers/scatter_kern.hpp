#pragma once

#include "kernels/mpm/points.hpp"
#include "kernels/mpm/transfers/stencil_kern.hpp"
#include "kernels/mpm/transfers/tile_kern.hpp"

namespace tread::mpm
{

/// Number of channels of a node plus one that pads to a vector register.
constexpr int lanes = 8;

/// A point's contribution to every node of its stencil is weight * (value + offset . per_offset) + slope . per_slope.
template<class Real>
struct PointLoad
{
    Real value[lanes];
    Real per_offset[3][lanes]; ///< times the node's offset from the point, m; affine transfers (APIC, AFLIP) only
    Real per_slope[3][lanes];  ///< times the weight's gradient, 1/m
};

/// Computes mass, momentum, contact force and internal force -V0 tau . grad w of a point (USL form), where tau is the
/// Kirchhoff stress: V0 tau is V sigma, and the stored energy is V0 psi(tau) for any change of volume.
template<class Real>
TREAD_HD PointLoad<Real> point_load(const PointsView<Real>& points, std::int64_t i)
{
    PointLoad<Real>  load{};
    const Real       mass      = points.mass[i];
    const Vec3<Real> velocity  = points.velocity.get(i);
    const Real       volume    = points.volume[i];
    const Sym3<Real> s         = points.stress.get(i);
    const int        row[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}}; // indices into Sym3
    load.value[0]              = mass;
    for (int a = 0; a < 3; ++a)
    {
        load.value[1 + a] = mass * velocity[a];
        for (int b = 0; b < 3; ++b) { load.per_slope[b][4 + a] = -volume * s[row[a][b]]; }
    }
    if (points.contact_force.data != nullptr)
    {
        const Vec3<Real> force = points.contact_force.get(i);
        for (int a = 0; a < 3; ++a) { load.value[4 + a] = force[a]; }
    }
    if (points.affine.data != nullptr)
    {
        for (int a = 0; a < 3; ++a)
        {
            for (int b = 0; b < 3; ++b)
            {
                load.per_offset[b][1 + a] = mass * points.affine.data[(3 * a + b) * points.affine.stride + i];
            }
        }
    }
    return load;
}

} // namespace tread::mpm
