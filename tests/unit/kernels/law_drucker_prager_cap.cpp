#include <algorithm>
#include <limits>
#include <numbers>

#include "law_support.hpp"

// Drucker-Prager with a cap: closed forms of isotropic compression and shear, conditions that define the return
// mapping, and the energy of random paths.
namespace law_drucker_prager_cap_test
{

using namespace tread;
using namespace tread::mpm;
using namespace tread::test;

const char* exact = "the return is exact for a whole step: rounding";

constexpr double cap = 1e4, cap_index = 0.02, young = 1e7;

template<class Real>
MaterialParameters<Real> sand(const Strength& strength)
{
    return make_material(make_elasticity<Real>(young, 0.3, 1500),
                         make_drucker_prager_cap<Real>(strength, ConeFit::compression, cap, cap_index));
}

double pressure_of(const Sym3<double>& stress) { return -(stress[0] + stress[1] + stress[2]) / 3; }

double radius_of(const Sym3<double>& stress)
{
    const double mean = -pressure_of(stress);
    return std::sqrt(0.5 * (stress.array().head<3>() - mean).square().sum() + stress.tail<3>().squaredNorm());
}

/// Compresses by `volume` (log volume strain) in equal steps; negative: expands.
void compress(Element& element, double volume, int steps)
{
    const double each = -volume / (3.0 * steps);
    for (int i = 0; i < steps; ++i) { element.strain(diagonal(each, each, each)); }
}

TEST(DruckerPragerCapPath, IsotropicCompressionFollowsTheVirginLine)
{
    for (const int steps : {1, 10, 1000})
    {
        Element      element{sand<double>({30, 5, 0})};
        const double bulk = element.material.bulk_modulus, yield = cap / bulk;
        compress(element, 0.9 * yield, 10);
        expect_law("p below the cap, Pa", pressure_of(element.stress), 0.9 * cap, 1e-12 * cap, "elastic: rounding");
        EXPECT_EQ(element.plastic_work, 0);
        compress(element, 0.1 * yield + 0.03, steps);
        // e = p/K + cap_index ln(p/cap): the volume strain of the pressure reached.
        const double p = pressure_of(element.stress);
        expect_law("volume strain of the virgin line", p / bulk + cap_index * std::log(p / cap), yield + 0.03, 1e-13,
                   exact);
        expect_law("p_c, Pa", element.state.cap_pressure, p, 1e-12 * p, exact);
        if (steps == 1000)
        {
            const double work = cap_index * (p - cap); // integral of p cap_index dp/p
            expect_law("work of compaction, J/m3", element.plastic_work, work, 2e-3 * work,
                       "the end of each step weighs: first order in a step of 1/1000");
        }
        compress(element, -0.5 * p / bulk, 7);
        expect_law("p after unloading, Pa", pressure_of(element.stress), 0.5 * p, 1e-10 * p, "elastic: rounding");
        compress(element, 0.5 * p / bulk + 0.001, 7);
        const double again = pressure_of(element.stress);
        expect_law("strain from p_c on", (again - p) / bulk + cap_index * std::log(again / p), 0.001, 1e-12, exact);
    }
}

TEST(DruckerPragerCapPath, ShearBelowTheCapEndsOnTheCone)
{
    Element      element{sand<double>({30, 0, 500})};
    const double p     = 0.5 * cap;
    const auto&  cone  = element.material.drucker_prager_cap.cone;
    Sym3<double> shear = Sym3<double>::Zero();
    shear[5]           = 1e-5;
    compress(element, p / element.material.bulk_modulus, 3);
    for (int i = 0; i < 400; ++i) { element.strain(shear); }
    expect_law("sqrt(J2), Pa", radius_of(element.stress), cone.limit + cone.slope * p, 1e-10 * p, exact);
    expect_law("p, Pa", pressure_of(element.stress), p, 1e-11 * p, "no dilation: rounding");
    EXPECT_EQ(element.state.cap_pressure, cap);
}

TEST(DruckerPragerCapPath, DilationAgainstTheCapIsTakenUpByCompaction)
{
    Element      element{sand<double>({30, 10, 0})};
    const double bulk = element.material.bulk_modulus, start = 0.8 * cap;
    const auto&  cone  = element.material.drucker_prager_cap.cone;
    Sym3<double> shear = Sym3<double>::Zero();
    shear[5]           = 1e-4;
    compress(element, start / bulk, 3);
    for (int i = 0; i < 500; ++i) { element.strain(shear); }
    // At constant volume dilation is stored as pressure or compacted: flow l = (p - p0)/K + cap_index ln(p/cap).
    // ln(p/cap).
    const double p = pressure_of(element.stress), multiplier = std::numbers::sqrt3 * element.state.plastic_shear;
    EXPECT_GT(p, 1.05 * cap) << "the path must meet the corner";
    expect_law("volume of the flow", (p - start) / bulk + cap_index * std::log(p / cap), cone.flow_slope * multiplier,
               1e-12, exact);
    expect_law("sqrt(J2), Pa", radius_of(element.stress), cone.limit + cone.slope * p, 1e-10 * p, exact);
}

TEST(DruckerPragerCapPath, SandStartsNormallyConsolidated)
{
    Element element{sand<double>({30, 0, 0})};
    element.stress = diagonal(-3 * cap, -3 * cap, -3 * cap);
    element.strain(Sym3<double>::Zero());
    expect_law("p_c of the first step, Pa", element.state.cap_pressure, 3 * cap, 1e-12 * cap, "rounding");
    expect_law("p of the first step, Pa", pressure_of(element.stress), 3 * cap, 1e-12 * cap, "rounding");
    const double bulk = element.material.bulk_modulus;
    compress(element, 0.01, 5);
    const double p = pressure_of(element.stress);
    expect_law("strain", (p - 3 * cap) / bulk + cap_index * std::log(p / (3 * cap)), 0.01, 1e-13, exact);
}

/// Largest violation of the return conditions over many states.
struct Violation
{
    double cone    = 0; ///< f / (sqrt(J2) + eta p + k)
    double cap     = 0; ///< p / p_c - 1
    double soft    = 0; ///< fall of p_c, over p_c
    double flow    = 0; ///< plastic volume beside flow l - cap_index ln(p_c1/p_c0), over the trial's strain
    double work    = 0; ///< negative plastic work, over trial^2 / G
    double balance = 0; ///< plastic work against stress : plastic strain, over trial^2 / G
    double again   = 0; ///< change in a second return, over the stress
    int    on_cone = 0, on_cap = 0, corner = 0;
};

void raise(double& worst, double value) { worst = value > worst || std::isnan(value) ? value : worst; }

template<class Real>
void check_state(const MaterialParameters<Real>& material, const Sym3<Real>& trial, Real start, Violation& worst)
{
    PlasticState<Real> state{};
    state.cap_pressure        = start;
    const auto         first  = respond(material, material.drucker_prager_cap, trial, state, Real(1));
    const auto         second = respond(material, material.drucker_prager_cap, first.stress, first.state, Real(1));
    const Sym3<double> before = trial.template cast<double>(), after = first.stress.template cast<double>();
    const auto&        law = material.drucker_prager_cap;
    const double       p = pressure_of(after), radius = radius_of(after), end = first.state.cap_pressure;
    const double       size  = std::max(radius_of(before), std::abs(pressure_of(before)));
    const double       shear = material.shear_modulus, bulk = material.bulk_modulus,
                 cone = law.cone.limit + law.cone.slope * p;
    raise(worst.cone, (radius - cone) / (radius + std::abs(law.cone.slope * p) + law.cone.limit + 1e-6 * size));
    raise(worst.cap, p / end - 1);
    raise(worst.soft, (start - end) / start);
    raise(worst.again, double((second.stress - first.stress).norm()) / size);

    const double drop = radius_of(before) - radius, volume = (p - pressure_of(before)) / bulk;
    const double unit = size * size / shear;
    raise(worst.work, -double(first.plastic_work) / unit);
    raise(worst.balance, std::abs(double(first.plastic_work) + p * volume - radius * drop / shear) / unit);
    if (first.state.volume_gap > 0) { return; }
    const double compaction = law.cap_index * std::log(end / start);
    raise(worst.flow, std::abs(volume - law.cone.flow_slope * drop / shear + compaction) * shear / size);
    const bool flows = drop > 1e-3 * size, hardens = end > Real(1.001) * start;
    worst.on_cone += flows && !hardens;
    worst.on_cap += hardens && !flows;
    worst.corner += flows && hardens;
}

template<class Real>
class DruckerPragerCapRandom : public ::testing::Test
{
};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DruckerPragerCapRandom, Reals);

TYPED_TEST(DruckerPragerCapRandom, StatesAreReturnedAsTheFlowAsks)
{
    Random         random(7);
    Violation      worst;
    const Strength materials[] = {{35, 5, 0}, {29, 0, 0}, {15, 0, 1000}, {40, 40, 500}, {0, 0, 3000}};
    for (int n = 0; n < 100000; ++n)
    {
        Sym3<double> trial;
        const double pressure = random.uniform(-0.5, 4) * cap;
        for (int c = 0; c < 6; ++c) { trial[c] = random.uniform(-1, 1) * cap - (c < 3 ? pressure : 0); }
        check_state<TypeParam>(sand<TypeParam>(materials[n % 5]), trial.cast<TypeParam>(),
                               TypeParam(random.uniform(1, 3) * cap), worst);
    }
    const double epsilon = std::numeric_limits<TypeParam>::epsilon();
    std::printf("  cone %d, cap %d, corner %d\n", worst.on_cone, worst.on_cap, worst.corner);
    EXPECT_GT(std::min({worst.on_cone, worst.on_cap, worst.corner}), 1000) << "all regions must be met";
    const char* rounding = "some ten roundings of the trial";
    expect_below("cone", worst.cone, 32 * epsilon, "tolerance of the law, and rounding of the stress");
    expect_below("cap", worst.cap, 20 * epsilon, "tolerance of the law, and rounding of the stress");
    expect_below("softening of the cap", worst.soft, 0, "p_c never falls");
    expect_below("flow", worst.flow, 64 * epsilon, rounding);
    expect_below("negative plastic work", worst.work, 16 * epsilon, rounding);
    expect_below("plastic work", worst.balance, 64 * epsilon, rounding);
    expect_below("second return", worst.again, 32 * epsilon, "no further than the law's tolerance");
}

/// The stress at the end of a step does at least the work that is stored and dissipated, whatever the step: the stored
/// energy is convex. A law that made energy would break this.
TEST(DruckerPragerCapPath, RandomPathsCreateNoEnergy)
{
    Random         random(8);
    double         created = 0, compacted = 0;
    const Strength materials[] = {{35, 5, 0}, {29, 0, 0}, {15, 15, 1000}, {0, 0, 3000}};
    for (int path = 0; path < 400; ++path)
    {
        Element      element{sand<double>(materials[path % 4])};
        Sym3<double> strain = Sym3<double>::Zero();
        double       work = 0, scale = 0;
        const auto   step = [&](const Sym3<double>& increment)
        {
            element.strain(increment);
            strain += increment;
            const Sym3<double>& s    = element.stress;
            const double        done = s.head<3>().dot(increment.head<3>()) + 2 * s.tail<3>().dot(increment.tail<3>());
            work += done;
            scale += std::abs(done);
            const double stored = elastic_energy_density<double>(element.material, s);
            created             = std::max(created, (stored + element.plastic_work - work) / scale);
        };
        for (int i = 0; i < 100; ++i)
        {
            Sym3<double> increment;
            for (int c = 0; c < 6; ++c) { increment[c] = random.uniform(-1, 1) * 1e-3 - (c < 3 ? 1e-4 : 0); }
            step(increment);
        }
        const Sym3<double> back = -strain / 50;
        for (int i = 0; i < 50; ++i) { step(back); }
        compacted = std::max(compacted, element.state.cap_pressure / cap);
    }
    EXPECT_GT(compacted, 1.5) << "paths must load the cap";
    expect_below("energy created, over the work done", created, 1e-12, "rounding of some hundred steps");
}

} // namespace law_drucker_prager_cap_test
