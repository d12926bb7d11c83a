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

/// Mass, momentum and stress of a point, as P2G hands them on. Lengths are in units of `unit`.
template<class Real>
struct PointTerms
{
    Real       mass;     ///< kg
    Vec3<Real> momentum; ///< N s
    Sym3<Real> stress;   ///< N m / unit: -V0 tau, of which the slope of the weight (per unit) makes a force
};

/// Computes mass, momentum and internal force -V0 tau . grad w of a point (USL form), where tau is the Kirchhoff
/// stress: V0 tau is V sigma, and the stored energy is V0 psi(tau) for any change of volume.
template<class Real>
TREAD_HD PointTerms<Real> point_terms(const PointsView<Real>& points, std::int64_t i, Real inverse_unit)
{
    const Real mass  = points.mass[i];
    const Real scale = -points.volume[i] * inverse_unit;
    return {mass, mass * points.velocity.get(i), scale * points.stress.get(i)};
}

/// Returns the contact force on a point, N; zero in a scene without bodies.
template<class Real>
TREAD_HD Vec3<Real> point_force(const PointsView<Real>& points, std::int64_t i)
{
    return points.contact_force.data != nullptr ? points.contact_force.get(i) : Vec3<Real>(Vec3<Real>::Zero());
}

/// Returns component `c` of the momentum per offset along `axis` that the affine field gives; `lever`: mass times the
/// unit of offsets.
template<class Real>
TREAD_HD Real affine_momentum(const PointsView<Real>& points, std::int64_t i, Real lever, int c, int axis)
{
    return lever * points.affine.data[(3 * c + axis) * points.affine.stride + i];
}

/// Computes the load of a point on the nodes of its stencil, lengths in m.
template<class Real>
TREAD_HD PointLoad<Real> point_load(const PointsView<Real>& points, std::int64_t i)
{
    PointLoad<Real>        load{};
    const PointTerms<Real> terms     = point_terms(points, i, Real(1));
    const Vec3<Real>       force     = point_force(points, i);
    const int              row[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}}; // indices into Sym3
    load.value[0]                    = terms.mass;
    for (int a = 0; a < 3; ++a)
    {
        load.value[1 + a] = terms.momentum[a];
        load.value[4 + a] = force[a];
        for (int b = 0; b < 3; ++b) { load.per_slope[b][4 + a] = terms.stress[row[a][b]]; }
    }
    if (points.affine.data == nullptr) { return load; }
    for (int a = 0; a < 3; ++a)
    {
        for (int b = 0; b < 3; ++b) { load.per_offset[b][1 + a] = affine_momentum(points, i, terms.mass, a, b); }
    }
    return load;
}

} // namespace tread::mpm
