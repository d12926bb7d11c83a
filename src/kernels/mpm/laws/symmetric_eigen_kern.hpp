#pragma once

#include <cmath>
#include <limits>

#include "backend/vector.hpp"

namespace tread::mpm
{

/// Principal values, descending, and the corresponding orthonormal axes, one per column.
template<class Real>
struct SymmetricEigen
{
    Vec3<Real> values;
    Mat3<Real> axes;
};

/// Returns the largest root, in [sqrt 3, 2], of x^3 - 3 x = 2 r for r in [0, 1]: x = 2 cos(acos(r)/3). Newton's
/// iteration starts from a parabola with an error of 3e-3 and squares it: 7e-6, 4e-11, 1e-21. The root is simple, so
/// that rounding of r is not amplified.
template<class Real>
TREAD_HD Real isolated_root(Real r)
{
    constexpr int iterations = sizeof(Real) == sizeof(float) ? 2 : 3;
    Real          x          = Real(1.7320508075688772) + r * (Real(0.33333333333333333) - Real(0.065384140902210) * r);
    for (int i = 0; i < iterations; ++i) { x = Real(2) * (x * x * x + r) / (Real(3) * (x * x - Real(1))); }
    return x;
}

/// Returns the unit null vector of a symmetric matrix of rank 2: the largest column of its adjugate.
template<class Real>
TREAD_HD Vec3<Real> null_vector(const Sym3<Real>& m)
{
    const Real xx = m[1] * m[2] - m[3] * m[3], yy = m[0] * m[2] - m[4] * m[4], zz = m[0] * m[1] - m[5] * m[5];
    const Real yz = m[4] * m[5] - m[0] * m[3], xz = m[5] * m[3] - m[1] * m[4], xy = m[4] * m[3] - m[2] * m[5];
    Vec3<Real> column(xx, xy, xz);
    Real       largest = std::abs(xx);
    if (std::abs(yy) > largest)
    {
        column  = Vec3<Real>(xy, yy, yz);
        largest = std::abs(yy);
    }
    if (std::abs(zz) > largest) { column = Vec3<Real>(xz, yz, zz); }
    return column * (Real(1) / std::sqrt(column.squaredNorm()));
}

template<class Real>
TREAD_HD Vec3<Real> times(const Sym3<Real>& m, const Vec3<Real>& v)
{
    return {m[0] * v[0] + m[5] * v[1] + m[4] * v[2], m[5] * v[0] + m[1] * v[1] + m[3] * v[2],
            m[4] * v[0] + m[3] * v[1] + m[2] * v[2]};
}

/// Larger and smaller principal value and axes of the deviator in the plane normal to the unit vector `normal`.
template<class Real>
struct PlaneEigen
{
    Real       high, low;
    Vec3<Real> high_axis, low_axis;
};

template<class Real>
TREAD_HD PlaneEigen<Real> plane_eigen(const Sym3<Real>& m, const Vec3<Real>& normal)
{
    // basis of the plane: Duff et al. 2017, J. Comput. Graph. Tech. 6(1)
    const Real       sign = std::copysign(Real(1), normal[2]);
    const Real       k    = Real(-1) / (sign + normal[2]);
    const Real       b    = normal[0] * normal[1] * k;
    const Vec3<Real> u(Real(1) + sign * normal[0] * normal[0] * k, sign * b, -sign * normal[0]);
    const Vec3<Real> w(b, sign + normal[1] * normal[1] * k, -normal[1]);

    const Vec3<Real> mu = times(m, u), mw = times(m, w);
    const Real       uu = u.dot(mu), ww = w.dot(mw), uw = u.dot(mw);
    const Real       half   = Real(0.5) * (uu - ww);
    const Real       radius = std::sqrt(half * half + uw * uw);
    const Real       large  = radius + std::abs(half);
    const Real       norm   = std::sqrt(large * large + uw * uw);
    Real             x = 1, y = 0;
    if (norm > std::numeric_limits<Real>::epsilon() * std::numeric_limits<Real>::epsilon())
    {
        const Real inverse = Real(1) / norm;
        x                  = (half >= 0 ? large : uw) * inverse;
        y                  = (half >= 0 ? uw : large) * inverse;
    }
    const Real mean = Real(0.5) * (uu + ww);
    return {mean + radius, mean - radius, x * u + y * w, x * w - y * u};
}

/// Mean and deviator of a tensor.
template<class Real>
struct Deviator
{
    Real       mean;
    Sym3<Real> tensor;
    Real       j2;
};

/// Subtracts the mean twice: for an almost spherical tensor, the first difference has a rounding trace as large as
/// itself.
template<class Real>
TREAD_HD Deviator<Real> deviator_of(const Sym3<Real>& tensor)
{
    constexpr Real third   = Real(1.0 / 3);
    const Real     rounded = (tensor[0] + tensor[1] + tensor[2]) * third;
    Deviator<Real> deviator{rounded, tensor, 0};
    Sym3<Real>&    s = deviator.tensor;
    for (int i = 0; i < 3; ++i) { s[i] -= rounded; }
    const Real rest = (s[0] + s[1] + s[2]) * third;
    deviator.mean += rest;
    for (int i = 0; i < 3; ++i) { s[i] -= rest; }
    for (int i = 0; i < 3; ++i) { deviator.j2 += Real(0.5) * s[i] * s[i] + s[3 + i] * s[3 + i]; }
    return deviator;
}

/// The most isolated principal value of a deviator, size * root; |root| in [sqrt 3, 2].
template<class Real>
struct IsolatedValue
{
    Real       size; ///< sqrt(J2/3); 0 if its square underflows
    Real       root;
    Sym3<Real> scaled; ///< deviator divided by size
};

template<class Real>
TREAD_HD IsolatedValue<Real> isolated_value(const Deviator<Real>& deviator)
{
    const Real third_j2 = deviator.j2 * Real(1.0 / 3);
    if (third_j2 <= std::numeric_limits<Real>::min()) { return {Real(0), Real(2), Sym3<Real>::Zero()}; }
    const Real       size = std::sqrt(third_j2);
    const Sym3<Real> s    = deviator.tensor * (Real(1) / size);
    const Real       determinant =
        s[0] * (s[1] * s[2] - s[3] * s[3]) - s[5] * (s[5] * s[2] - s[3] * s[4]) + s[4] * (s[5] * s[3] - s[1] * s[4]);
    const Real r = Real(0.5) * std::abs(determinant);
    return {size, std::copysign(isolated_root(r > Real(1) ? Real(1) : r), determinant), s};
}

/// Largest and smallest principal value, without axes, and an upper bound of their error.
template<class Real>
struct PrincipalRange
{
    Real major, minor, error;
};

/// Computes the range: the other roots of the cubic are (-x +- sqrt(12 - 3 x^2))/2 for the isolated root x. Near x = 2,
/// where they coincide, rounding of x is amplified to its square root.
template<class Real>
TREAD_HD PrincipalRange<Real> principal_range(Real mean, const IsolatedValue<Real>& isolated)
{
    constexpr Real precision = sizeof(Real) == sizeof(float) ? Real(2e-3) : Real(1e-7);
    const Real     x = std::abs(isolated.root), inside = Real(12) - Real(3) * x * x;
    const Real     far   = Real(0.5) * (x + std::sqrt(inside > 0 ? inside : Real(0)));
    const Real     alone = mean + isolated.size * isolated.root,
               other     = mean - std::copysign(isolated.size * far, isolated.root);
    return {isolated.root > 0 ? alone : other, isolated.root > 0 ? other : alone, isolated.size * precision};
}

/// Computes the eigen-decomposition of a symmetric 3 x 3 tensor without iterative rotations: first the most isolated
/// principal value, from the characteristic cubic of the deviator, where its root is simple; then its axis; then the
/// plane problem, which is exact for close and equal values (Scherzinger and Dohrmann 2008, Comput. Methods Appl. Mech.
/// Eng. 197:4007). A deviator whose square underflows counts as zero. NaN in, NaN out.
template<class Real>
TREAD_HD SymmetricEigen<Real> symmetric_eigen(Real mean, const IsolatedValue<Real>& isolated)
{
    if (isolated.size == 0) { return {Vec3<Real>::Constant(mean), Mat3<Real>::Identity()}; }
    const Real size = isolated.size, root = isolated.root;
    Sym3<Real> singular = isolated.scaled;
    for (int i = 0; i < 3; ++i) { singular[i] -= root; }
    const Vec3<Real>       axis  = null_vector(singular);
    const PlaneEigen<Real> plane = plane_eigen(isolated.scaled, axis);

    SymmetricEigen<Real> eigen;
    const Real           alone = mean + size * root, high = mean + size * plane.high, low = mean + size * plane.low;
    if (root > 0)
    {
        eigen.values << alone, high, low;
        eigen.axes << axis, plane.high_axis, plane.low_axis;
    }
    else
    {
        eigen.values << high, low, alone;
        eigen.axes << plane.high_axis, plane.low_axis, axis;
    }
    return eigen;
}

template<class Real>
TREAD_HD SymmetricEigen<Real> symmetric_eigen(const Sym3<Real>& tensor)
{
    const Deviator<Real> deviator = deviator_of(tensor);
    return symmetric_eigen(deviator.mean, isolated_value(deviator));
}

/// Computes the sum of values[i] axes_i axes_i^T. The mean is added separately, so that rounding of the axes affects
/// only the deviator.
template<class Real>
TREAD_HD Sym3<Real> from_principal(const Vec3<Real>& values, const Mat3<Real>& axes)
{
    const Real       mean = values.sum() * Real(1.0 / 3);
    const Mat3<Real> m    = axes * Vec3<Real>(values.array() - mean).asDiagonal() * axes.transpose();
    Sym3<Real>       tensor;
    tensor << mean + m(0, 0), mean + m(1, 1), mean + m(2, 2), m(1, 2), m(0, 2), m(0, 1);
    return tensor;
}

} // namespace tread::mpm
