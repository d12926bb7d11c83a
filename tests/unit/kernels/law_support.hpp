#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "kernels/mpm/laws/law_kern.hpp"

// Shared by the tests of the material laws.
namespace tread::test
{

/// Prints one number of a law and checks it against its closed form.
inline void expect_law(const std::string& what, double measured, double expected, double tolerance, const char* why)
{
    std::printf("  %-46s measured %.9g expected %.9g tolerance %.2g (%s)\n", what.c_str(), measured, expected,
                tolerance, why);
    EXPECT_NEAR(measured, expected, tolerance) << what;
}

/// Prints and checks the largest of many errors.
inline void expect_below(const std::string& what, double measured, double limit, const char* why)
{
    std::printf("  %-46s measured %.3g limit %.3g (%s)\n", what.c_str(), measured, limit, why);
    EXPECT_LE(measured, limit) << what;
}

inline Mat3<double> random_rotation(Random& random)
{
    const Vec3<double> axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    return Eigen::AngleAxisd(random.uniform(0, 3.14), axis.normalized()).toRotationMatrix();
}

inline Sym3<double> symmetric(const Mat3<double>& m)
{
    Sym3<double> s;
    s << m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1);
    return s;
}

inline Sym3<double> diagonal(double xx, double yy, double zz)
{
    Sym3<double> s;
    s << xx, yy, zz, 0, 0, 0;
    return s;
}

/// A sand point strained without spin.
template<class Real>
struct BasicElement
{
    mpm::MaterialParameters<Real> material;
    Sym3<Real>                    stress = Sym3<Real>::Zero();
    mpm::PlasticState<Real>       state{};
    Real                          plastic_work = 0; ///< J/m3
    Real                          volume_ratio = 1;

    /// Strains by an increment of tensor components.
    void strain(const Sym3<Real>& increment)
    {
        state.volume_ratio = volume_ratio;
        const auto update  = mpm::update_stress(material, stress, state, mpm::full_matrix(increment), Real(1));
        stress             = update.stress;
        state              = update.state;
        volume_ratio *= std::exp(increment[0] + increment[1] + increment[2]);
        plastic_work += update.plastic_work;
    }

    /// Strains by `increment` + x `free`, with x in [-reach, reach] such that stress component `held` keeps `value`.
    /// Returns x.
    Real strain_holding(const Sym3<Real>& increment, const Sym3<Real>& free, int held, Real value, Real reach)
    {
        Real low = -reach, high = reach;
        for (int bisection = 0; bisection < 80; ++bisection)
        {
            const Real   middle = Real(0.5) * (low + high);
            BasicElement copy   = *this;
            copy.strain(increment + middle * free);
            (copy.stress[held] > value ? high : low) = middle;
        }
        strain(increment + low * free);
        return low;
    }
};

using Element = BasicElement<double>;

} // namespace tread::test
