#include <cmath>
#include <numbers>

#include "footing.hpp"

namespace footing_test
{

using namespace tread;

template<class Exec>
class FullSizeFooting : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FullSizeFooting, test::Backends, test::BackendNames);

constexpr double prandtl = 5141.6; // Pa, (2 + pi) c of 1 kPa

/// Tolerance of a value at B/infinity extrapolated from B/6 and B/10, the set-up of C4: the second-order part of the
/// edge's error, (O(h) / B)^2, leaves 1 to 3 %; settlement deepens the footing, 1 % (Brinch Hansen: 1 + 0.4 D / B);
/// waves contribute 1 to 2 %.
constexpr double extrapolated = 0.06;

/// Weightless clay, c = 1 kPa.
test::Footing clay(int cells, const std::string& volume_strain)
{
    test::Footing footing;
    footing.soil          = "model = \"mohr-coulomb\"\nyoung = 1.0e6\nfriction_angle_deg = 0.0\ncohesion = 1000.0";
    footing.poisson       = 0.49;
    footing.cells         = cells;
    footing.volume_strain = volume_strain;
    return footing;
}

/// phi = 20 degrees.
test::Footing frictional(int cells, double dilation, double cohesion)
{
    test::Footing footing;
    footing.soil       = fmt::format("model = \"mohr-coulomb\"\nyoung = 2.0e6\nfriction_angle_deg = 20.0\n"
                                           "dilation_angle_deg = {}\ncohesion = {}",
                                     dilation, cohesion);
    footing.cells      = cells;
    footing.reach      = 3.5;
    footing.depth      = 1.5;
    footing.settlement = 0.025;
    return footing;
}

/// docs/verification.md#strip-footing (i): the load reaches Prandtl's q = (2 + pi) c and stays there; with the
/// volumetric strain of every single point it is larger, and rises.
TYPED_TEST(FullSizeFooting, UndrainedClayCarriesPrandtlsLoadWithCellAverages)
{
    const double plateau = 0.02;
    const auto   push    = [&](int cells, const std::string& volume_strain)
    {
        const test::Footing footing = clay(cells, volume_strain);
        auto                loads   = test::FootingTest<TypeParam>(this->exec(), footing).run(12);
        print("clay", footing, loads);
        return loads;
    };
    const auto   coarse = push(3, "cell-average"), fine = push(5, "cell-average"), locked = push(5, "point");
    const double load = test::last_quarter(fine) / prandtl;
    test::report("load over (2 + pi) c at B/10", load, 1.1, 0.1,
                 "docs/verification.md#strip-footing: 5-10 % at B/20, so 10-20 % at B/10");
    EXPECT_NEAR(load, 1.1, 0.1);
    const double limit = test::at_infinitely_many(3, test::last_quarter(coarse) / prandtl, 5, load);
    test::report("from B/6 and B/10, at B/infinity", limit, 1, extrapolated, "second order, settlement, waves");
    EXPECT_NEAR(limit, 1, extrapolated);
    const double rise = test::last_quarter(fine) / test::third_quarter(fine) - 1;
    test::report("rise from the third quarter of the settlement", rise, 0, plateau, "at most: a plateau");
    EXPECT_LT(rise, plateau);
    const double excess = test::last_quarter(locked) / test::last_quarter(fine) - 1;
    test::report("load beyond that, every point by itself", excess, plateau, 0, "at least: it locks");
    EXPECT_GT(excess, plateau);
}

/// Weightless, c = 1 kPa, phi = psi = 20 degrees: N_c c = (N_q - 1) cot phi c (Prandtl, Reissner).
template<class Exec>
void expect_load_of_prandtl_and_reissner(const Exec& exec, const std::string& volume_strain)
{
    const double tan   = std::tan(20 * std::numbers::pi / 180);
    const double n_q   = std::exp(std::numbers::pi * tan) * std::pow(std::tan(55 * std::numbers::pi / 180), 2);
    const double exact = 1000 * (n_q - 1) / tan;
    double       over[2];
    for (const int cells : {3, 5})
    {
        test::Footing footing = frictional(cells, 20, 1000);
        footing.volume_strain = volume_strain;
        const auto loads      = test::FootingTest<Exec>(exec, footing).run(12);
        print("phi = psi = 20, c = 1 kPa", footing, loads);
        over[cells / 4] = test::last_quarter(loads) / exact;
    }
    const double limit = test::at_infinitely_many(3, over[0], 5, over[1]);
    test::report(volume_strain + ": load over N_c c at B/6 " + std::to_string(over[0]) + ", at B/10 " +
                     std::to_string(over[1]) + ", at B/infinity",
                 limit, 1, extrapolated, "second order, settlement, waves");
    EXPECT_NEAR(limit, 1, extrapolated);
}

/// With nodal forces from every single point's pressure, cell averages of dilating sand were unstable here.
TYPED_TEST(FullSizeFooting, CohesionAndFrictionCarryPrandtlsLoadWithCellAverages)
{
    expect_load_of_prandtl_and_reissner(this->exec(), "cell-average");
}

TYPED_TEST(FullSizeFooting, CohesionAndFrictionCarryPrandtlsLoad)
{
    expect_load_of_prandtl_and_reissner(this->exec(), "point");
}

/// A collapsing column of 20 cm, nearly incompressible.
std::string column(const std::string& soil, const std::string& volume_strain)
{
    return R"(
title = "column"
[domain]
size    = [0.6, 0.025, 0.3]
gravity = [0.0, 0.0, -9.81]
[grid]
spacing = 0.025
[numerics]
volume_strain = ")" +
           volume_strain + R"("
[[material]]
name    = "soil"
density = 1600.0
young   = 1.0e6
poisson = 0.499
)" + soil + R"(
[[terrain]]
material = "soil"
region   = { box = [[0.0, 0.0, 0.0], [0.2, 0.025, 0.2]] }
[[phase]]
name     = "fall"
duration = 0.15
)";
}

/// phi = 0, c = 0 and nu -> 0.499 give finite states and generate no energy.
TYPED_TEST(FullSizeFooting, LimitsOfTheLawsMakeNoEnergy)
{
    const std::string cone        = "model = \"drucker-prager\"\ndrucker_prager_fit = \"plane-strain\"\n",
                      hexagon     = "model = \"mohr-coulomb\"\n";
    const std::string strengths[] = {"friction_angle_deg = 0.0", "friction_angle_deg = 0.0\ncohesion = 100.0",
                                     "friction_angle_deg = 30.0"};
    for (const std::string& law : {hexagon, cone})
    {
        for (const std::string& strength : strengths)
        {
            const std::string           text = column(law + strength, law == cone ? "cell-average" : "point");
            test::Experiment<TypeParam> fall(this->exec(), text);
            const auto                  energy = [&]
            {
                const solver::SandCensus now = fall.simulation().census().sand;
                return now.kinetic + now.strain + 9.81 * now.moment[2];
            };
            const double start = energy(), mass = fall.simulation().census().sand.mass;
            double       highest = start;
            int          step    = 0;
            fall.run(
                [&](double)
                {
                    if (++step % 50 == 0) { highest = std::max(highest, energy()); }
                });
            // Velocities are half a step behind positions: m g v dt / 2, v of the free fall from the top.
            const double tolerance = mass * 9.81 * std::sqrt(2 * 9.81 * 0.2) * fall.dt();
            test::report("largest gain of energy in J, " + law + strength, highest - start, 0, tolerance,
                         "twice what half a step of falling makes; " + std::to_string(start) + " J at the start");
            EXPECT_TRUE(std::isfinite(energy()));
            EXPECT_LT(highest - start, tolerance);
            EXPECT_LT(energy(), 0.99 * start) << "it must fall";
        }
    }
}

} // namespace footing_test
