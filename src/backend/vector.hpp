#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "backend/execution.hpp"

// Small vectors for item functions. EIGEN_MAX_STATIC_ALIGN_BYTES=0 (CMakeLists.txt) gives them the same layout in both
// compilers.
namespace tread
{

template<class Real>
using Vec3 = Eigen::Matrix<Real, 3, 1>;
template<class Real>
using Mat3 = Eigen::Matrix<Real, 3, 3>;

/// Symmetric tensor: xx, yy, zz, yz, xz, xy.
template<class Real>
using Sym3 = Eigen::Matrix<Real, 6, 1>;

template<class Real>
TREAD_HD Mat3<Real> full(const Sym3<Real>& s)
{
    Mat3<Real> m;
    m << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
    return m;
}

template<class Real>
TREAD_HD Sym3<Real> symmetric(const Mat3<Real>& m)
{
    Sym3<Real> s;
    s << m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1);
    return s;
}

using Quat = Eigen::Quaternion<double>;

/// Components stored in planes, `stride` values apart: neighbouring items are neighbours in memory (coalesced access).
template<class Real, int components>
struct Planes
{
    Real*        data   = nullptr;
    std::int64_t stride = 0;

    TREAD_HD Eigen::Matrix<Real, components, 1> get(std::int64_t i) const
    {
        Eigen::Matrix<Real, components, 1> value;
        for (int c = 0; c < components; ++c) { value[c] = data[c * stride + i]; }
        return value;
    }

    TREAD_HD void set(std::int64_t i, const Eigen::Matrix<Real, components, 1>& value) const
    {
        for (int c = 0; c < components; ++c) { data[c * stride + i] = value[c]; }
    }
};

} // namespace tread
