#include <numbers>

#include <Eigen/Eigenvalues>

#include "law_support.hpp"

// Element tests of sand that knows its density: strength and dilation by Bolton's index, and the critical state.
namespace
{

using namespace tread;
using namespace tread::mpm;
using namespace tread::test;

constexpr double            critical_angle = 33, young = 1e9, cell_pressure = 5e4;
constexpr DensityDependence dense{0.8, 0.6, 1.0}, loose{0.1, 0.6, 1.0};

MaterialParameters<double> sand(const DensityDependence& density)
{
    return make_material(make_elasticity<double>(young, 0.25, 1600),
                         make_bolton<double>({critical_angle, 0, 0}, density));
}

/// I_R under 150 kPa with Q = 10 and R = 1: some 5 I_D - 1.
double index_at(double relative_density) { return relative_density * (10 - std::log(150.0)) - 1; }

/// I_D after the volume of the skeleton has changed by this ratio.
double density_at(const DensityDependence& density, double ratio)
{
    const double initial = density.initial_void_ratio();
    return (density.void_ratio_max - ((1 + initial) * ratio - 1)) / (density.void_ratio_max - density.void_ratio_min);
}

/// Axial strain along z in small steps at a constant cell pressure.
struct Triaxial
{
    explicit Triaxial(const DensityDependence& density)
        : element{sand(density)}
    {
        element.stress = diagonal(-cell_pressure, -cell_pressure, -cell_pressure);
    }

    void compress(double axial, int steps)
    {
        const double step = axial / steps;
        for (int i = 0; i < steps; ++i)
        {
            lateral =
                element.strain_holding(diagonal(0, 0, -step), diagonal(1, 1, 0), 0, -cell_pressure, 10 * step) / step;
        }
    }

    /// Mobilised friction angle, degrees.
    double angle() const
    {
        const double high = -element.stress[2], low = -element.stress[0];
        return std::asin((high - low) / (high + low)) * 180 / std::numbers::pi;
    }

    Element element;
    double  lateral = 0; ///< lateral over axial strain of the last step
};

TEST(Bolton, PeakStrengthAndDilation)
{
    for (const DensityDependence& density : {dense, loose})
    {
        Triaxial test(density);
        // Yields at some 2e-4 of strain; the volume has then changed by 1e-5 at most.
        test.compress(4e-4, 40);
        const double index = index_at(density.relative_density);
        expect_law("friction angle at first yield, degrees", test.angle(), critical_angle + 3 * index, 0.01,
                   "the density has changed by 1e-3 of I_D since the start");
        expect_law("d eps_v / d eps_1", 1 - 2 * test.lateral, -0.3 * index, 0.01, "the same");
    }
}

/// With J the volume ratio and e the axial strain, dJ/de = 0.3 J I_R and I_R linear in J: a logistic curve.
TEST(Bolton, VolumeFollowsTheLogisticCurveToTheCriticalState)
{
    for (const DensityDependence& density : {dense, loose})
    {
        Triaxial     test(density);
        const double per_density = 10 - std::log(150.0);
        const double slope       = per_density * (1 + density.initial_void_ratio()) / 0.4,
                     start       = index_at(density.relative_density);
        const double last        = (start + slope) / slope;
        for (const double axial : {0.05, 0.1, 0.2, 0.4, 0.8})
        {
            static double before = 0;
            before               = axial == 0.05 ? 0 : before;
            test.compress(axial - before, 2000);
            before                = axial;
            const double expected = last / (1 + (last - 1) * std::exp(-0.3 * (start + slope) * axial));
            expect_law("volume ratio", test.element.volume_ratio, expected, 2e-3 * std::abs(last - 1) + 1e-4,
                       "elastic strains of 2e-4, and first order in 2.5e-5 to 2e-4 of strain");
        }
        const double friction = critical_angle + 3 * index_at(density_at(density, test.element.volume_ratio));
        expect_law("friction angle, degrees", test.angle(), friction, 1e-3,
                   "exact return at the density before the step");
    }
}

TEST(Bolton, DenseAndLooseEndAtTheSameVoidRatio)
{
    double ends[2];
    for (int i = 0; i < 2; ++i)
    {
        const DensityDependence& density = i == 0 ? dense : loose;
        Triaxial                 test(density);
        test.compress(3, 6000);
        ends[i] = (1 + density.initial_void_ratio()) * test.element.volume_ratio - 1;
        expect_law("critical friction angle, degrees", test.angle(), critical_angle, 0.02,
                   "exponential approach, e^-6");
        expect_law("critical void ratio", ends[i], 1 - 0.4 / (10 - std::log(150.0)), 1e-3, "I_R = 0");
    }
}

/// Weighs the mean log volume ratio by m and the own one by 1 - m; the gap is no part of the skeleton.
TEST(Bolton, SeesTheMeanOfItsSurroundings)
{
    DensityDependence nonlocal = dense;
    nonlocal.nonlocal_weight   = 2;
    const auto            law  = make_bolton<double>({critical_angle, 0, 0}, nonlocal);
    PlasticState<double>  state{0, 0, 0.01, std::exp(0.04)};
    constexpr const char* why = "the formula, to rounding";
    expect_law("skeleton of a law without a length", seen_skeleton(make_bolton<double>({33, 0, 0}, dense), state),
               std::exp(0.03), 1e-15, why);
    for (const double mean : {0.0, 0.01, 0.03})
    {
        state.mean_strain = mean;
        expect_law("seen skeleton", seen_skeleton(law, state), std::exp(2 * mean - 0.03), 1e-15, why);
    }
}

TEST(Bolton, PressureSuppressesDilation)
{
    const auto law = make_bolton<double>({critical_angle, 0, 0}, dense);
    for (const double kilopascal : {1.0, 150.0, 300.0, 1000.0, 1e4})
    {
        const double expected = 0.8 * (10 - std::log(std::max(kilopascal, 150.0))) - 1;
        expect_law("I_R", dilatancy_index(law, 1.0, -1e3 * kilopascal), expected, 1e-12, "the formula");
    }
    expect_law("I_R of grains apart", dilatancy_index(law, 1.5, -1e3), -1, 1e-12, "I_D is not below 0");
    expect_law("I_R at most", dilatancy_index(make_bolton<double>({33, 0, 0}, {1.0, 0.6, 1.0}), 0.9, -1e3), 4, 0.02,
               "Bolton's limit is 4; I_D is not above 1");
}

/// Mohr-Coulomb constants of the density before the step, as the law takes them.
template<class Real>
MohrCoulomb<Real> strength_before(const MaterialParameters<Real>& material, const Sym3<Real>& trial,
                                  const PlasticState<Real>& state)
{
    const Real mean = (trial[0] + trial[1] + trial[2]) * Real(1.0 / 3);
    return strength_at(material.bolton, dilatancy_index(material.bolton, seen_skeleton(material.bolton, state), mean));
}

/// Yield function over |s1| + |s3| + c.
template<class Real>
double beyond_yield(const MohrCoulomb<Real>& strength, const Sym3<Real>& stress)
{
    const Mat3<double> full  = full_matrix(Sym3<double>(stress.template cast<double>()));
    const Vec3<double> sigma = Eigen::SelfAdjointEigenSolver<Mat3<double>>(full, Eigen::EigenvaluesOnly).eigenvalues();
    const MohrCoulomb<double> exact{strength.sin_friction, strength.cos_friction, 0, strength.cohesion, 0};
    return yield_function(exact, sigma[2], sigma[0]) / (std::abs(sigma[2]) + std::abs(sigma[0]) + exact.cohesion);
}

/// Random strain increments from random stresses, with random means of the surroundings: every number finite,
/// dissipation never negative, stress admissible.
template<class Real>
void random_paths(double nonlocal_weight)
{
    Random            random(7);
    DensityDependence density = dense;
    density.nonlocal_weight   = nonlocal_weight;
    const auto material = make_material(make_elasticity<Real>(1e7, 0.3, 1600), make_bolton<Real>({30, 0, 50}, density));
    double     least = 0, beyond = 0;
    for (int path = 0; path < 2000; ++path)
    {
        Sym3<Real>         stress = Sym3<Real>::Zero();
        PlasticState<Real> state{};
        Real               ratio = static_cast<Real>(random.uniform(0.7, 1.5));
        for (int step = 0; step < 500; ++step)
        {
            Mat3<Real>   gradient;
            const double size = std::pow(10.0, random.uniform(-7, -2));
            for (int i = 0; i < 9; ++i) { gradient(i) = static_cast<Real>(random.uniform(-1, 1) * size); }
            state.volume_ratio  = ratio;
            state.mean_strain   = static_cast<Real>(random.uniform(-0.3, 0.3));
            const auto strength = strength_before(material, trial_stress(material, stress, gradient, Real(1)), state);
            const auto update   = update_stress(material, stress, state, gradient, Real(1));
            beyond              = std::max(beyond, beyond_yield(strength, update.stress));
            stress              = update.stress;
            state               = update.state;
            ratio *= std::exp(gradient.trace());
            least = std::min(least, static_cast<double>(update.plastic_work));
            ASSERT_TRUE(stress.allFinite() && std::isfinite(state.volume_gap) && std::isfinite(state.plastic_shear));
        }
    }
    expect_below("largest energy made in a step of 1e6, J/m3", -least, sizeof(Real) == 4 ? 1e-2 : 1e-9,
                 "rounding of stresses to 1e5 Pa times strains to 1e-2");
    expect_below("yield function over the stress", beyond,
                 yield_tolerance<Real> + 10 * std::numeric_limits<Real>::epsilon(),
                 "what the law counts as elastic, and its principal values (law_eigen)");
}

TEST(Bolton, RandomPaths) { random_paths<double>(0); }
TEST(Bolton, RandomPathsSingle) { random_paths<float>(0); }
TEST(Bolton, RandomPathsAmongAnySurroundings) { random_paths<double>(2); }
TEST(Bolton, RandomPathsAmongAnySurroundingsSingle) { random_paths<float>(2); }

} // namespace
