#include <algorithm>
#include <limits>
#include <numbers>

#include "law_support.hpp"

// Drucker-Prager: states in which each fit has the Mohr-Coulomb strength, and conditions that define the return
// mapping.
namespace
{

using namespace tread;
using namespace tread::mpm;
using namespace tread::test;

const char* exact = "exact return: rounding, and a solved component to 1e-12";

constexpr Strength strengths[] = {{35, 5, 0}, {29, 0, 0}, {15, 0, 100}, {30, 30, 50}};
constexpr ConeFit  fits[]      = {ConeFit::compression, ConeFit::extension, ConeFit::plane_strain};

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

template<class Real>
MaterialParameters<Real> sand(const Strength& strength, ConeFit fit, double poisson = 0.3)
{
    return make_material(make_elasticity<Real>(1e6, poisson, 1500), make_drucker_prager<Real>(strength, fit));
}

/// Mohr-Coulomb ratio of the largest principal pressure to the smallest, `cell` (Pa); sign = -1: of the smallest to the
/// largest.
double mohr_coulomb_strength(const Strength& strength, double cell, double sign)
{
    const double sine = std::sin(radians(strength.friction_angle_deg));
    const double n    = (1 + sign * sine) / (1 - sign * sine);
    return n * cell + sign * 2 * strength.cohesion * std::sqrt(n);
}

/// Triaxial test at `cell` (Pa) under axial strain steps: axial pressure at the end and the last lateral step.
struct TriaxialEnd
{
    double axial, lateral, step;
};

TriaxialEnd triaxial(const MaterialParameters<double>& material, double cell, double step)
{
    Element element{material};
    element.stress = diagonal(-cell, -cell, -cell);
    double lateral = 0;
    for (int i = 0; i < 400; ++i)
    {
        lateral = element.strain_holding(diagonal(0, 0, step), diagonal(1, 1, 0), 0, -cell, 10 * std::abs(step));
    }
    return {-element.stress[2], lateral, step};
}

TEST(DruckerPragerPath, CompressionFitHasTheTriaxialStrengthAndDilation)
{
    for (const Strength& strength : strengths)
    {
        const TriaxialEnd end      = triaxial(sand<double>(strength, ConeFit::compression), 1e3, -1e-4);
        const double      ultimate = mohr_coulomb_strength(strength, 1e3, 1);
        expect_law("compressive strength, Pa", end.axial, ultimate, 1e-9 * ultimate, exact);
        const double sine = std::sin(radians(strength.dilation_angle_deg)), n = (1 + sine) / (1 - sine);
        expect_law("d eps_v / d eps_1", 1 + 2 * end.lateral / end.step, 1 - n, 1e-9, exact);
    }
}

TEST(DruckerPragerPath, ExtensionFitHasTheExtensiveStrengthAndDilation)
{
    for (const Strength& strength : strengths)
    {
        const TriaxialEnd end      = triaxial(sand<double>(strength, ConeFit::extension), 1e3, 1e-5);
        const double      ultimate = mohr_coulomb_strength(strength, 1e3, -1);
        expect_law("extensive strength, Pa", end.axial, ultimate, 1e-9 * 1e3, exact);
        const double sine = std::sin(radians(strength.dilation_angle_deg));
        expect_law("d eps_v / d eps_axial", 1 + 2 * end.lateral / end.step, 2 * sine / (1 + sine), 1e-9, exact);
    }
}

/// Strain along z, none along y, at a constant sigma_x.
TEST(DruckerPragerPath, PlaneStrainFitHasTheStrengthInAPlane)
{
    for (const Strength& strength : strengths)
    {
        Element element{sand<double>(strength, ConeFit::plane_strain)};
        element.stress = diagonal(-1e3, -1e3, -1e3);
        double lateral = 0;
        for (int i = 0; i < 3000; ++i)
        {
            lateral = element.strain_holding(diagonal(0, 0, -1e-4), diagonal(1, 0, 0), 0, -1e3, 1e-3);
        }
        const double ultimate = mohr_coulomb_strength(strength, 1e3, 1);
        const char*  flow     = "sigma_y approaches its value exponentially";
        expect_law("strength in the plane, Pa", -element.stress[2], ultimate, 1e-7 * ultimate, flow);
        expect_law("sin of the dilation angle", (lateral - 1e-4) / (lateral + 1e-4),
                   std::sin(radians(strength.dilation_angle_deg)), 1e-6, flow);
    }
}

TEST(DruckerPragerPath, FitsAreOrderedAsTheirCones)
{
    // Slopes of 30 degrees, de Souza Neto et al. 2008, 6.4: 6 s / (sqrt 3 (3 -+ s)), 3 tan / sqrt(9 + 12 tan^2).
    const Strength strength{30, 30, 0};
    const auto     slope = [&](ConeFit fit) { return make_drucker_prager<double>(strength, fit).slope; };
    expect_law("outer edges", slope(ConeFit::compression), 3 / (std::numbers::sqrt3 * 2.5), 1e-15, "rounding");
    expect_law("inner edges", slope(ConeFit::extension), 3 / (std::numbers::sqrt3 * 3.5), 1e-15, "rounding");
    expect_law("plane strain", slope(ConeFit::plane_strain), std::numbers::sqrt3 / std::sqrt(13.0), 1e-15, "rounding");
}

TEST(DruckerPragerPath, WithoutFrictionIsVonMises)
{
    for (const ConeFit fit : fits)
    {
        const auto   material = sand<double>({0, 0, 100}, fit, 0.499);
        const auto   update   = respond(material, material.drucker_prager, diagonal(1e5 + 900, 1e5, 1e5 - 900),
                                        PlasticState<double>{}, 1.0);
        const double mean     = update.stress.head<3>().sum() / 3;
        const double j2       = 0.5 * (update.stress.array().head<3>() - mean).square().sum();
        // The hexagon for c = 100 Pa has sqrt(J2) = 2 c / sqrt 3 at its edges and c in pure shear.
        const double limit = fit == ConeFit::plane_strain ? 100 : 200 / std::numbers::sqrt3;
        expect_law("sqrt(J2), Pa", std::sqrt(j2), limit, 1e-9, "rounding of 1e5 Pa");
        expect_law("mean at any tension, Pa", mean, 1e5, 1e-9, "rounding of 1e5 Pa");
    }
}

TEST(DruckerPragerPath, ApexOpensAndClosesAsTheHexagons)
{
    for (const ConeFit fit : fits)
    {
        Element      element{sand<double>({15, 0, 600}, fit)};
        const double apex = 600 / std::tan(radians(15)), bulk = element.material.bulk_modulus;
        for (int i = 0; i < 100; ++i) { element.strain(diagonal(1e-3, 1e-3, 1e-3)); }
        expect_law("tension at the apex, Pa", element.stress[0], apex, 1e-9 * apex, "c cot phi, whatever the fit");
        expect_law("log volume opened", element.state.volume_gap, 0.3 - apex / bulk, 1e-12, exact);
        const double opening = element.plastic_work;
        expect_law("work of opening, J/m3", opening, apex * (0.3 - apex / bulk), 1e-9 * opening, exact);
        for (int i = 0; i < 100; ++i) { element.strain(diagonal(-1e-3, -1e-3, -1e-3)); }
        expect_law("stress at zero strain, Pa", element.stress.norm(), 0, 1e-6, exact);
        expect_law("gap at zero strain", element.state.volume_gap, 0, 1e-12, exact);
    }
}

TEST(DruckerPragerPath, ApartGrainsDoNotDilate)
{
    Element element{sand<double>({35, 20, 0}, ConeFit::compression)};
    element.strain(diagonal(1e-2, 0, 0));
    const double gap = element.state.volume_gap;
    EXPECT_NEAR(gap, 1e-2, 1e-12);
    for (int i = 0; i < 100; ++i) { element.strain(diagonal(-2e-4, 1e-4, 1e-4)); }
    expect_law("stress of sheared open sand, Pa", element.stress.norm(), 0, 1e-8, exact);
    expect_law("gap after isochoric shear", element.state.volume_gap, gap, 1e-14, exact);
}

/// Largest violation of the return conditions over many states.
struct Violation
{
    double yield   = 0; ///< f / (sqrt(J2) + eta |m| + k)
    double lode    = 0; ///< deviator against the trial's, over the trial
    double flow    = 0; ///< volumetric strain against eta_flow times the shear, over the strain
    double work    = 0; ///< negative plastic work, over trial x strain
    double balance = 0; ///< plastic work against stress : plastic strain, over trial^2 / G
    double again   = 0; ///< change in a second return, over the stress
    double shear   = 0; ///< plastic shear of a second return
    int    cone = 0, apex = 0;
};

void raise(double& worst, double value) { worst = value > worst || std::isnan(value) ? value : worst; }

template<class Real>
void check_state(const Strength& strength, ConeFit fit, const Sym3<Real>& trial, Violation& worst)
{
    const auto material = sand<Real>(strength, fit);
    const auto first    = respond(material, material.drucker_prager, trial, PlasticState<Real>{}, Real(1));
    const auto second   = respond(material, material.drucker_prager, first.stress, PlasticState<Real>{}, Real(1));

    const auto         law    = make_drucker_prager<double>(strength, fit);
    const Mat3<double> before = full_matrix(Sym3<double>(trial.template cast<double>()));
    const Mat3<double> after  = full_matrix(Sym3<double>(first.stress.template cast<double>()));
    const Mat3<double> one    = Mat3<double>::Identity();
    const double       mean = after.trace() / 3, size = before.norm();
    const Mat3<double> s = after - mean * one, t = before - before.trace() / 3 * one;
    const double       radius = s.norm() / std::numbers::sqrt2;
    raise(worst.yield,
          (radius + law.slope * mean - law.limit) / (radius + law.slope * std::abs(mean) + law.limit + 1e-30));
    raise(worst.again, (second.stress - first.stress).norm() / std::max<Real>(first.stress.norm(), Real(1e-30)));
    if (first.state.plastic_shear == 0 && first.plastic_work == 0) { return; }
    raise(worst.shear, double(second.state.plastic_shear));
    raise(worst.lode, (s - s.cwiseProduct(t).sum() / t.squaredNorm() * t).norm() / size);

    const double       shear = material.shear_modulus, bulk = material.bulk_modulus;
    const double       volume  = (before.trace() / 3 - mean) / bulk;
    const Mat3<double> plastic = (t - s) / (2 * shear) + volume / 3 * one;
    raise(worst.work, -double(first.plastic_work) / (size * plastic.norm()));
    raise(worst.balance,
          std::abs(double(first.plastic_work) - after.cwiseProduct(plastic).sum()) * shear / (size * size));
    if ((t - s).norm() < 1e-2 * size) { return; }
    const double multiplier = (t - s).norm() / (std::numbers::sqrt2 * shear);
    const bool   apex       = radius < 1e-5 * size;
    ++(apex ? worst.apex : worst.cone);
    const double beside = volume - law.flow_slope * multiplier;
    raise(worst.flow, (apex ? -beside : std::abs(beside)) / plastic.norm());
}

template<class Real>
class DruckerPragerRandom : public ::testing::Test
{
};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DruckerPragerRandom, Reals);

TYPED_TEST(DruckerPragerRandom, StatesAreReturnedAsTheFlowAsks)
{
    Random         random(4);
    Violation      worst;
    const Strength materials[] = {{35, 5, 0}, {29, 0, 0}, {15, 0, 100}, {40, 40, 50}, {0, 0, 300}};
    for (int n = 0; n < 150000; ++n)
    {
        Sym3<double> trial;
        for (int c = 0; c < 6; ++c) { trial[c] = random.uniform(-3000, 3000) - (c < 3 ? random.uniform(0, 4000) : 0); }
        check_state<TypeParam>(materials[n % 5], fits[n / 5 % 3], trial.cast<TypeParam>(), worst);
    }
    const double epsilon = std::numeric_limits<TypeParam>::epsilon();
    std::printf("  cone %d, apex %d\n", worst.cone, worst.apex);
    EXPECT_GT(std::min(worst.cone, worst.apex), 1000) << "both regions must be met";
    const char* rounding = "some ten roundings of the trial";
    expect_below("yield function", worst.yield, 16 * epsilon, "tolerance of the law");
    expect_below("turn of the deviator", worst.lode, 16 * epsilon, rounding);
    expect_below("flow beside the cone's", worst.flow, 3000 * epsilon,
                 "the same over strains of at least 1 % of the trial");
    expect_below("negative plastic work", worst.work, 16 * epsilon, rounding);
    expect_below("plastic work", worst.balance, 16 * epsilon, rounding);
    expect_below("second return", worst.again, 16 * epsilon, "no further than the law's tolerance");
    expect_below("plastic shear of a second return", worst.shear, 0, "below the law's tolerance: elastic");
}

TEST(DruckerPragerReturn, FloatFollowsDouble)
{
    Random         random(6);
    const Strength strength{35, 5, 20};
    double         worst  = 0;
    const auto     single = sand<float>(strength, ConeFit::plane_strain);
    const auto     full   = sand<double>(strength, ConeFit::plane_strain);
    for (int n = 0; n < 100000; ++n)
    {
        Sym3<double> trial;
        for (int c = 0; c < 6; ++c) { trial[c] = double(float(random.uniform(-3000, 3000) - (c < 3 ? 2000 : 0))); }
        const auto rounded =
            respond(single, single.drucker_prager, Sym3<float>(trial.cast<float>()), PlasticState<float>{}, 1.0f);
        const auto precise = respond(full, full.drucker_prager, trial, PlasticState<double>{}, 1.0);
        raise(worst, (rounded.stress.cast<double>() - precise.stress).norm() / full_matrix(trial).norm());
    }
    expect_below("|float - double| / |trial|", worst, 32 * 1.2e-7, "roundings of trial, moduli and cone");
}

} // namespace
