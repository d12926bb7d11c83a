#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "law_support.hpp"

// Mohr-Coulomb return mapping: exact vectors, and the conditions that define it on random states.
namespace law_return_test
{

using namespace tread;
using namespace tread::mpm;
using namespace tread::test;

struct Angles
{
    double friction, dilation, cohesion, poisson;
};

template<class Real>
MaterialParameters<Real> sand(const Angles& a)
{
    return make_material(make_elasticity<Real>(1e6, a.poisson, 1500),
                         make_mohr_coulomb<Real>({a.friction, a.dilation, a.cohesion}));
}

template<class Real>
StressUpdate<Real> returned_by(const MaterialParameters<Real>& material, const Sym3<Real>& trial,
                               const PlasticState<Real>& state, Real dt)
{
    return respond(material, material.mohr_coulomb, trial, state, dt);
}

Sym3<double> returned(const Angles& angles, const Sym3<double>& trial)
{
    return returned_by(sand<double>(angles), trial, PlasticState<double>{}, 1.0).stress;
}

void expect_vector(const char* what, const Sym3<double>& measured, const Vec3<double>& expected)
{
    for (int c = 0; c < 3; ++c)
    {
        expect_law(what, measured[c], expected[c], 1e-6, "the vectors are given to 1e-6 Pa");
        EXPECT_NEAR(measured[3 + c], 0, 1e-9);
    }
}

TEST(MohrCoulombReturn, ExactVectors)
{
    expect_vector("plane", returned({35, 5, 0, 0.3}, diagonal(-1000, -3500, -9000)),
                  {-2225.620809, -3631.563542, -8212.924332});
    expect_vector("apex, c = 0", returned({35, 5, 0, 0.3}, diagonal(3000, 2500, 2000)), {0, 0, 0});
    expect_vector("apex, c cot phi", returned({15, 0, 100, 0.3}, diagonal(900, 800, 700)),
                  {373.205081, 373.205081, 373.205081});
}

TEST(MohrCoulombReturn, TrescaKeepsTheMeanAtAnyTension)
{
    for (const double mean : {-1e5, 0.0, 1e5})
    {
        const Sym3<double> stress   = returned({0, 0, 100, 0.3}, diagonal(mean + 900, mean + 100, mean - 1000));
        const double       rounding = 1e-15 * (1e3 + std::abs(mean));
        expect_law("s1 - s3 = 2 c, Pa", stress[0] - stress[2], 200, 10 * rounding, "rounding");
        expect_law("mean, Pa", stress.head<3>().sum() / 3, mean, 10 * rounding, "rounding");
    }
}

TEST(MohrCoulombReturn, InvariantBoundNeverSkipsAYieldingState)
{
    Random random(5);
    int    skipped = 0, elastic = 0;
    for (int n = 0; n < 300000; ++n)
    {
        const Angles angles{random.uniform(0, 60), 0, random.uniform() < 0.5 ? 0 : random.uniform(0, 500), 0.3};
        const auto   material = sand<double>(angles);
        const double mean     = random.uniform(-2000, 500);
        Vec3<double> s(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        s = (s.array() - s.sum() / 3) * 2000 * random.uniform();
        std::sort(s.begin(), s.end(), std::greater<>());
        const double f = yield_function(material.mohr_coulomb, mean + s[0], mean + s[2]);
        elastic += f <= 0;
        if (!inside_inscribed_cone(material.mohr_coulomb, mean, 0.5 * s.squaredNorm())) { continue; }
        ++skipped;
        ASSERT_LE(f, 1e-12 * (std::abs(mean) + s.norm() + angles.cohesion));
    }
    std::printf("  elastic states %d, of which the bound finds %d\n", elastic, skipped);
    EXPECT_GT(skipped, elastic / 2) << "the bound should spare most decompositions";
}

/// Largest violation of the return conditions over many states.
struct Violation
{
    double yield   = 0; ///< f / (|s1| + |s3| + c)
    double order   = 0; ///< of the returned values along the trial axes, over the trial
    double axes    = 0; ///< shear along the trial axes, over the trial
    double flow    = 0; ///< strain outside the cone of the active surfaces, over the strain
    double work    = 0; ///< negative plastic work, over trial x strain
    double balance = 0; ///< plastic work against stress : plastic strain, over trial^2 / G
    double again   = 0; ///< change in a second return, over the stress
    double shear   = 0; ///< plastic shear of a second return, over the first
    int    plane = 0, right = 0, left = 0, apex = 0;
};

void raise(double& worst, double value) { worst = value > worst || std::isnan(value) ? value : worst; }

/// Distance of the principal plastic strain e from the cone that the surfaces active at s span, over |e|. With
/// a = 1 + sin psi and b = 1 - sin psi the surface of (i, j) flows along a e_i - b e_j (Koiter).
double outside_cone(const Angles& angles, const Vec3<double>& s, const Vec3<double>& e, double equal, Violation& seen)
{
    const double sine = std::sin(angles.dilation * std::numbers::pi / 180), a = 1 + sine, b = 1 - sine;
    const bool   upper = s[0] - s[1] <= equal, lower = s[1] - s[2] <= equal;
    double       out = 0;
    if (upper && lower && angles.friction > 0)
    {
        ++seen.apex;
        raise(out, -(b * (e[0] + e[1]) + a * e[2]));
        raise(out, -(b * e[0] + a * (e[1] + e[2])));
    }
    else if (lower)
    {
        ++seen.right;
        raise(out, std::abs(b * e[0] + a * (e[1] + e[2])));
        raise(out, std::max(e[1], e[2]));
    }
    else if (upper)
    {
        ++seen.left;
        raise(out, std::abs(a * e[2] + b * (e[0] + e[1])));
        raise(out, -std::min(e[0], e[1]));
    }
    else
    {
        ++seen.plane;
        raise(out, std::abs(b * e[0] + a * e[2]));
        raise(out, std::abs(e[1]));
        raise(out, -e[0]);
    }
    return out / e.norm();
}

template<class Real>
void check_state(const Angles& angles, const Sym3<Real>& trial, Violation& worst)
{
    const auto material = sand<Real>(angles);
    const auto first    = returned_by(material, trial, PlasticState<Real>{}, Real(1));
    const auto second   = returned_by(material, first.stress, PlasticState<Real>{}, Real(1));

    const Mat3<double> before = full_matrix(Sym3<double>(trial.template cast<double>()));
    const Mat3<double> after  = full_matrix(Sym3<double>(first.stress.template cast<double>()));
    const Eigen::SelfAdjointEigenSolver<Mat3<double>> trial_axes(before), after_axes(after);

    const Vec3<double> s     = after_axes.eigenvalues();
    const double       f     = yield_function(sand<double>(angles).mohr_coulomb, s[2], s[0]);
    const double       scale = std::abs(s[2]) + std::abs(s[0]) + angles.cohesion;
    raise(worst.yield, f / std::max(scale, std::numeric_limits<double>::min()));
    raise(worst.again, (second.stress - first.stress).norm() / std::max<Real>(first.stress.norm(), Real(1e-30)));
    if (first.state.plastic_shear == 0) { return; }
    raise(worst.shear, double(second.state.plastic_shear) / double(first.state.plastic_shear));

    const Mat3<double> v     = trial_axes.eigenvectors().rowwise().reverse();
    const Mat3<double> local = v.transpose() * after * v;
    const Vec3<double> now = local.diagonal(), drop = trial_axes.eigenvalues().reverse() - now;
    const double       size = before.norm(), mean = drop.sum() / 3;
    const Vec3<double> plastic =
        (drop.array() - mean) / (2.0 * double(material.shear_modulus)) + mean / (3.0 * double(material.bulk_modulus));
    raise(worst.order, std::max(now[1] - now[0], now[2] - now[1]) / size);
    raise(worst.axes, (local - Mat3<double>(now.asDiagonal())).norm() / size);
    raise(worst.work, -double(first.plastic_work) / (size * plastic.norm()));
    raise(worst.balance,
          std::abs(double(first.plastic_work) - now.dot(plastic)) * double(material.shear_modulus) / (size * size));
    // Strains within the rounding of the stress have no meaningful direction.
    if (drop.norm() < 1e-2 * size) { return; }
    const double equal = 100 * std::numeric_limits<Real>::epsilon() * size;
    raise(worst.flow, outside_cone(angles, now, plastic, equal, worst));
}

template<class Real>
class MohrCoulombRandom : public ::testing::Test
{
};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(MohrCoulombRandom, Reals);

TYPED_TEST(MohrCoulombRandom, StatesAreReturnedAsKoiterAsks)
{
    Random       random(4);
    Violation    worst;
    const Angles materials[] = {{35, 5, 0, 0.3},   {29, 0, 0, 0.25}, {15, 0, 100, 0.3},
                                {40, 40, 50, 0.1}, {0, 0, 300, 0.3}, {30, 20, 1000, 0.45}};
    for (int n = 0; n < 1000000; ++n)
    {
        const Angles& angles = materials[n % 6];
        Sym3<double>  trial;
        for (int c = 0; c < 6; ++c) { trial[c] = random.uniform(-3000, 3000) - (c < 3 ? random.uniform(0, 4000) : 0); }
        check_state<TypeParam>(angles, trial.cast<TypeParam>(), worst);
    }
    const double epsilon = std::numeric_limits<TypeParam>::epsilon();
    std::printf("  plane %d, right edge %d, left edge %d, apex %d\n", worst.plane, worst.right, worst.left, worst.apex);
    EXPECT_GT(std::min({worst.plane, worst.right, worst.left, worst.apex}), 1000) << "every region must be met";
    const char* rounding = "roundings of the decomposition, as in law_eigen";
    expect_below("yield function", worst.yield, sizeof(TypeParam) == 8 ? 1e-9 : 16 * epsilon, "tolerance of the law");
    expect_below("order", worst.order, 16 * epsilon, rounding);
    expect_below("axes", worst.axes, 16 * epsilon, rounding);
    expect_below("flow outside the cone", worst.flow, 3000 * epsilon,
                 "the same over strains of at least 1 % of the trial");
    expect_below("negative plastic work", worst.work, 16 * epsilon, rounding);
    expect_below("plastic work", worst.balance, 16 * epsilon, rounding);
    expect_below("second return", worst.again, 16 * epsilon, "no further than the law's tolerance");
    expect_below("plastic shear of a second return", worst.shear, 0, "below the law's tolerance: elastic");
}

TEST(MohrCoulombReturn, FloatFollowsDouble)
{
    Random       random(6);
    const Angles angles{35, 5, 20, 0.3};
    double       worst = 0;
    for (int n = 0; n < 100000; ++n)
    {
        Sym3<double> trial;
        for (int c = 0; c < 6; ++c) { trial[c] = double(float(random.uniform(-3000, 3000) - (c < 3 ? 2000 : 0))); }
        const auto single =
            returned_by(sand<float>(angles), Sym3<float>(trial.cast<float>()), PlasticState<float>{}, 1.0f);
        const Sym3<double> exact = returned(angles, trial);
        raise(worst, (single.stress.cast<double>() - exact).norm() / full_matrix(trial).norm());
    }
    expect_below("|float - double| / |trial|", worst, 32 * 1.2e-7, "roundings of trial, moduli and decomposition");
}

} // namespace law_return_test
