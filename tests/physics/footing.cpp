#include <cmath>

#include "footing.hpp"

namespace
{

using namespace tread;

template<class Exec>
class FootingPhysics : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FootingPhysics, test::Backends, test::BackendNames);

/// Weightless clay, c = 1 kPa.
test::Footing clay()
{
    test::Footing footing;
    footing.soil = R"(model = "mohr-coulomb"
young = 1.0e6
poisson = 0.49
friction_angle_deg = 0.0
cohesion = 1000.0)";
    return footing;
}

void print(const std::string& what, const std::vector<test::FootingLoad>& loads)
{
    std::cout << "  " << what << ", settlement / B: pressure in Pa:";
    for (const auto& load : loads) { std::cout << " " << load.settlement << ": " << load.pressure; }
    std::cout << "\n";
}

/// verification C4 (i): q = (2 + pi) c of Prandtl, and it stays there; with every point's own volumetric strain it is
/// more.
TYPED_TEST(FootingPhysics, UndrainedClayCarriesPrandtlsLoadWithCellAverages)
{
    const double plateau = 0.02;
    const auto   rise    = [](const auto& loads) { return loads[11].pressure / loads[8].pressure - 1; };
    const auto   push    = [&](const std::string& volume_strain)
    {
        test::Footing footing = clay();
        footing.volume_strain = volume_strain;
        return test::FootingTest<TypeParam>(this->exec(), footing).run(12);
    };
    const auto averaged = push("cell-average"), locked = push("point");
    print("clay, cell averages", averaged);
    print("clay, every point by itself", locked);
    test::report("load over (2 + pi) c", averaged.back().pressure / 5141.6, 1.125, 0.125,
                 "C4: 5-10 % at 10 cells a half width, so 10-20 % at 5; and waves: rho c_s v = 370 Pa, 7 %");
    EXPECT_NEAR(averaged.back().pressure / 5141.6, 1.125, 0.125);
    test::report("rise over the last quarter of the settlement", rise(averaged), 0, plateau, "at most: a plateau");
    EXPECT_LT(rise(averaged), plateau);
    const double excess = locked.back().pressure / averaged.back().pressure - 1;
    test::report("load beyond that, every point by itself", excess, plateau, 0, "at least: it locks");
    EXPECT_GT(excess, plateau);
}

/// Column of 20 cm that falls apart, nearly incompressible.
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

/// Issue: phi = 0, c = 0 and nu -> 0.499 run, give finite states and make no energy.
TYPED_TEST(FootingPhysics, LimitsOfTheLawsMakeNoEnergy)
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
            // Velocities stand half a step off the positions: m g v dt / 2, v of the free fall from the top.
            const double tolerance = mass * 9.81 * std::sqrt(2 * 9.81 * 0.2) * fall.dt();
            test::report("largest gain of energy in J, " + law + strength, highest - start, 0, tolerance,
                         "twice what half a step of falling makes; " + std::to_string(start) + " J at the start");
            EXPECT_TRUE(std::isfinite(energy()));
            EXPECT_LT(highest - start, tolerance);
            EXPECT_LT(energy(), 0.99 * start) << "it must fall";
        }
    }
}

} // namespace
