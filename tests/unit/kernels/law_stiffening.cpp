#include <array>
#include <numbers>

#include "law_support.hpp"

// Stiffness that grows with the root of pressure: tangents, stored energy, and strength and flow that stay.
namespace law_stiffening_test
{

using namespace tread;
using namespace tread::mpm;
using namespace tread::test;

constexpr double young = 2e7, poisson = 0.25, stiff_pressure = 1e5;

template<class Real>
MaterialParameters<Real> sand(const Strength& strength = {35, 5, 0})
{
    return make_material(make_elasticity<Real>(young, poisson, 1600, stiff_pressure),
                         make_mohr_coulomb<Real>(strength));
}

Sym3<double> pressed(double pressure) { return diagonal(-pressure, -pressure, -pressure); }

/// Tangent of stress component `row` to a strain of 1e-6.
double tangent(const Sym3<double>& stress, const Sym3<double>& direction, int row)
{
    Element      ahead{sand<double>(), stress}, back{sand<double>(), stress};
    const double size = 1e-6;
    ahead.strain(size * direction);
    back.strain(-size * direction);
    return (ahead.stress[row] - back.stress[row]) / (2 * size);
}

TEST(Stiffening, TangentsGrowWithTheRootOfPressure)
{
    const double bulk = young / (3 * (1 - 2 * poisson)), shear = young / (2 * (1 + poisson));
    Sym3<double> turn = Sym3<double>::Zero();
    turn[3]           = 1;
    for (const double pressure : {1e2, 1e3, 1e4, 9.9e4})
    {
        const double root = std::sqrt(pressure / stiff_pressure);
        const char*  why  = "second order in strains of 1e-6 over elastic ones of 1e-4 and more";
        expect_law("bulk modulus, Pa", tangent(pressed(pressure), diagonal(1, 1, 1), 0) / 3, bulk * root,
                   1e-3 * bulk * root, why);
        expect_law("shear modulus, Pa", tangent(pressed(pressure), turn, 3) / 2, shear * root / 2, 1e-3 * shear * root,
                   why);
    }
    for (const double pressure : {1.01e5, 1e6, 1e8})
    {
        const double x = (pressure / stiff_pressure + 1) / 2;
        expect_law("bulk modulus above p_s, Pa", tangent(pressed(pressure), diagonal(1, 1, 1), 0) / 3, bulk,
                   1e-3 * bulk, "the tangent goes on");
        expect_law("shear modulus above p_s, Pa", tangent(pressed(pressure), turn, 3) / 2, shear * (1 - 0.5 / x),
                   1e-3 * shear, "h/x");
    }
}

/// Strain of a bed that settles: |t|^2 = K M strain^2, with M the modulus of uniaxial strain.
TEST(Stiffening, UniaxialStrain)
{
    Element element{sand<double>({60, 0, 0})}; // strong, so that it stays elastic
    for (int i = 0; i < 1000; ++i) { element.strain(diagonal(0, 0, -1e-6)); }
    const auto&  m        = element.material;
    const double uniaxial = m.lame_modulus + 2 * m.shear_modulus, strain = 1e-3;
    const double expected = std::sqrt(m.bulk_modulus * uniaxial) * strain / stiff_pressure * uniaxial * strain;
    expect_law("stress, Pa", -element.stress[2], expected, 1e-9 * expected, "rounding of a thousand steps");
    expect_law("K_0", element.stress[0] / element.stress[2], poisson / (1 - poisson), 1e-9, "the same");
}

/// The steepest of many tangents is that of the time step.
TEST(Stiffening, NoWaveIsFasterThanTheTimeStepAllows)
{
    Random       random(3);
    const double most     = 1600 * std::pow(sand<double>().wave_speed, 2);
    double       steepest = 0;
    for (int i = 0; i < 20000; ++i)
    {
        const double pressure = std::pow(10, random.uniform(1, 7));
        Sym3<double> stress   = pressed(pressure);
        // Within the yield limit of 35 degrees.
        for (int c = 0; c < 6; ++c) { stress[c] += pressure * random.uniform(-0.2, 0.2); }
        const Mat3<double> turn = random_rotation(random);
        const Sym3<double> wave = symmetric(turn * Vec3<double>(1, 0, 0).asDiagonal() * turn.transpose());
        Element            element{sand<double>(), stress};
        const double       size = 1e-7;
        element.strain(-size * wave);
        const Mat3<double> change = full_matrix(Sym3<double>(stress - element.stress));
        steepest                  = std::max(steepest, turn.col(0).dot(change * turn.col(0)) / size);
    }
    expect_below("steepest tangent over that of the time step", steepest / most, 1, "a bound over all states");
    EXPECT_GT(steepest / most, 0.8) << "a bound far from what occurs would waste steps";
}

/// Closed paths of elastic strain give back what they took.
TEST(Stiffening, ElasticPathsStoreTheirWork)
{
    Random random(5);
    for (const double pressure : {3e3, 1.2e5})
    {
        Element      element{sand<double>(), pressed(pressure)};
        const double before = elastic_energy_density(element.material, element.stress);
        double       work = 0, turned_over = 0;
        Sym3<double> total = Sym3<double>::Zero(), velocity = Sym3<double>::Zero();
        const double size   = 1e-3 * pressure / young / std::sqrt(pressure / stiff_pressure);
        const auto   strain = [&](const Sym3<double>& by)
        {
            const Sym3<double> then = element.stress;
            element.strain(by);
            const double power =
                full_matrix(Sym3<double>(0.5 * (then + element.stress))).cwiseProduct(full_matrix(by)).sum();
            work += power;
            turned_over += std::abs(power);
            total += by;
        };
        for (int i = 0; i < 20000; ++i)
        {
            for (int c = 0; c < 6; ++c) { velocity[c] += size * random.uniform(-1, 1); }
            strain(velocity);
            velocity -= 0.02 * velocity + 1e-3 * total; // pulled back, so that the path stays elastic
        }
        for (int i = 0; i < 2000; ++i) { strain(-total / (2000 - i)); }
        const double after = elastic_energy_density(element.material, element.stress);
        ASSERT_EQ(element.plastic_work, 0) << "the path must be elastic";
        expect_law("stress after the loop over its start", element.stress[0] / -pressure, 1, 1e-9, "rounding");
        expect_below("energy made in the loop over the work turned over",
                     std::abs(work - (after - before)) / turned_over, 1e-4,
                     "the mean of two stresses is second order in steps of 1e-3 to 1e-2 of the elastic strain");
    }
}

/// What the laws see is parallel to the stress: the same friction angle and the same dilation as with one modulus.
TEST(Stiffening, StrengthAndFlowStay)
{
    constexpr double cell = 2e3;
    Element          element{sand<double>(), pressed(cell)};
    double           lateral = 0, last = 0;
    for (int i = 0; i < 4000; ++i)
    {
        last    = 1e-6;
        lateral = element.strain_holding(diagonal(0, 0, -last), diagonal(1, 1, 0), 0, -cell, 10 * last);
    }
    const double sine = std::sin(35 * std::numbers::pi / 180), dilation = std::sin(5 * std::numbers::pi / 180);
    expect_law("stress ratio", element.stress[2] / element.stress[0], (1 + sine) / (1 - sine), 1e-9, "exact return");
    expect_law("lateral over axial strain", lateral / last, 0.5 * (1 + dilation) / (1 - dilation), 1e-6,
               "d eps_3 = (1 + sin psi)/(1 - sin psi)/2 d eps_1 at a constant stress");
}

/// Sand that opened and closed stands under the same stress as at its start.
TEST(Stiffening, AGapClosesAndLoadsAsBefore)
{
    Element element{sand<double>(), pressed(500)};
    for (int i = 0; i < 100; ++i) { element.strain(diagonal(1e-4, 1e-4, 1e-4)); }
    EXPECT_EQ(element.stress.norm(), 0);
    for (int i = 0; i < 100; ++i) { element.strain(diagonal(-1e-4, -1e-4, -1e-4)); }
    expect_law("pressure, Pa", -element.stress[0], 500, 1e-9, "rounding of two hundred steps");
    expect_law("gap", element.state.volume_gap, 0, 1e-15, "closed");
}

/// A million steps without strain: the stress is converted to the linear one and back in each.
TEST(Stiffening, StressAtRestStays)
{
    for (const double pressure : {30.0, 7e3, 3e5})
    {
        BasicElement<float> element{sand<float>()};
        element.stress << -float(pressure), -float(0.5 * pressure), -float(0.6 * pressure), 0, 0, float(0.1 * pressure);
        const Sym3<float> before = element.stress;
        for (int i = 0; i < 1000000; ++i) { element.strain(Sym3<float>::Zero()); }
        expect_below("change of a stress at rest, relative", double((element.stress - before).norm() / before.norm()),
                     1e-3, "roundings of 6e-8 that do not add up with one sign would make 6e-5");
    }
}

/// Random strains from random stresses: finite numbers, no dissipation below zero, work stored or dissipated.
template<class Real>
void random_paths()
{
    Random random(11);
    double least = 0, supplied = 0, kept = 0;
    for (int path = 0; path < 2000; ++path)
    {
        BasicElement<Real> element{sand<Real>()};
        double             lost = 0;
        for (int step = 0; step < 500; ++step)
        {
            const double size = std::pow(10.0, random.uniform(-7, -3));
            Sym3<Real>   strain;
            for (int c = 0; c < 6; ++c)
            {
                strain[c] = static_cast<Real>((random.uniform(-1, 1) - (c < 3 ? 0.2 : 0)) * size);
            }
            const auto update =
                update_stress(element.material, element.stress, element.state, full_matrix(strain), Real(1));
            const Sym3<double> mean = 0.5 * (element.stress + update.stress).template cast<double>();
            supplied += full_matrix(mean).cwiseProduct(full_matrix(Sym3<double>(strain.template cast<double>()))).sum();
            least = std::min(least, static_cast<double>(update.plastic_work));
            lost += update.plastic_work + update.work_to_mean;
            element.stress = update.stress;
            element.state  = update.state;
            ASSERT_TRUE(element.stress.allFinite() && std::isfinite(element.state.volume_gap));
        }
        kept += lost + elastic_energy_density(element.material, element.stress);
    }
    expect_below("largest energy made in a step of 1e6, J/m3", -least, sizeof(Real) == 4 ? 1e-2 : 1e-9,
                 "rounding of stresses to 1e5 Pa times strains to 1e-3");
    std::printf("  supplied %.6g J/m3, stored and dissipated %.6g\n", supplied, kept);
    expect_below("unaccounted over supplied", std::abs(supplied - kept) / supplied, 0.02,
                 "the mean of two stresses of a step is second order; steps here reach the whole elastic strain");
}

TEST(Stiffening, RandomPaths) { random_paths<double>(); }
TEST(Stiffening, RandomPathsSingle) { random_paths<float>(); }

} // namespace law_stiffening_test
