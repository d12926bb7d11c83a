#pragma once

#include "backend/vector.hpp"

namespace tread::mpm
{

template<class Real>
TREAD_HD Mat3<Real> full_matrix(const Sym3<Real>& s)
{
    Mat3<Real> m;
    m << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
    return m;
}

/// Computes D dt, tensor components, with D = symmetric part of the velocity gradient (1/s).
template<class Real>
TREAD_HD Sym3<Real> strain_increment(const Mat3<Real>& gradient, Real dt)
{
    const Real half = Real(0.5) * dt;
    Sym3<Real> strain;
    strain << dt * gradient(0, 0), dt * gradient(1, 1), dt * gradient(2, 2), half * (gradient(1, 2) + gradient(2, 1)),
        half * (gradient(0, 2) + gradient(2, 0)), half * (gradient(0, 1) + gradient(1, 0));
    return strain;
}

/// Computes R - I of the rotation R = (I - W dt/2)^-1 (I + W dt/2), W = skew part of the velocity gradient: a proper
/// rotation for any step (Hughes and Winget 1980, Int. J. Numer. Methods Eng. 15:1862). With W dt/2 = [a]x it is 2/(1 +
/// a.a) ([a]x + a a^T - a.a I), Cayley's formula.
template<class Real>
TREAD_HD Mat3<Real> rotation_increment(const Mat3<Real>& gradient, Real dt)
{
    const Real       quarter = Real(0.25) * dt;
    const Vec3<Real> a       = quarter * Vec3<Real>(gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0),
                                              gradient(1, 0) - gradient(0, 1));
    const Real       aa      = a.squaredNorm();
    Mat3<Real>       q;
    q << a[0] * a[0] - aa, a[0] * a[1] - a[2], a[0] * a[2] + a[1], //
        a[1] * a[0] + a[2], a[1] * a[1] - aa, a[1] * a[2] - a[0],  //
        a[2] * a[0] - a[1], a[2] * a[1] + a[0], a[2] * a[2] - aa;
    return Real(2) / (Real(1) + aa) * q;
}

/// Computes R stress R^T - stress for R = I + `rotation`. It is computed as an increment, so that the rounding of a
/// small rotation is small compared with the stress: fp32 conserves |stress| over many rotations.
template<class Real>
TREAD_HD Sym3<Real> rotation_of_stress(const Sym3<Real>& stress, const Mat3<Real>& rotation)
{
    const Mat3<Real> p = rotation * full_matrix(stress);
    const Mat3<Real> q = p * rotation.transpose();
    Sym3<Real>       change;
    change << Real(2) * p(0, 0) + q(0, 0), Real(2) * p(1, 1) + q(1, 1), Real(2) * p(2, 2) + q(2, 2),
        p(1, 2) + p(2, 1) + q(1, 2), p(0, 2) + p(2, 0) + q(0, 2), p(0, 1) + p(1, 0) + q(0, 1);
    return change;
}

} // namespace tread::mpm
