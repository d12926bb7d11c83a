#include "footing.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "order.hpp"

// Footings too expensive for the quick tests (docs/verification.md#strip-footing): finer grids, and sand without
// cohesion.
namespace
{

using namespace tread;

template<class Exec>
class FootingSlow : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FootingSlow, test::Backends, test::BackendNames);

/// Mean pressure, Pa, over the last quarter of the settlement.
template<class Exec>
double push(const Exec& exec, const std::string& what, const test::Footing& footing)
{
    const auto loads = test::FootingTest<Exec>(exec, footing).run(12);
    print(what, footing, loads);
    return test::last_quarter(loads);
}

/// Weightless clay, c = 1 kPa, nu = 0.49: q = (2 + pi) c.
TYPED_TEST(FootingSlow, UndrainedClayConvergesToPrandtlWithCellAverages)
{
    constexpr double prandtl = 5141.6; // Pa
    test::Footing    footing;
    footing.soil    = "model = \"mohr-coulomb\"\nyoung = 1.0e6\nfriction_angle_deg = 0.0\ncohesion = 1000.0";
    footing.poisson = 0.49;
    std::array<double, 3> over{};
    std::size_t           at = 0;
    for (const int cells : {3, 5, 10})
    {
        footing.cells = cells;
        over[at++]    = push(this->exec(), "clay", footing) / prandtl - 1;
    }
    test::report("over-prediction at B/20", over[2], 0.075, 0.025,
                 "docs/verification.md#strip-footing: 5-10 % acceptable");
    EXPECT_NEAR(over[2], 0.075, 0.025);
    const auto fit = test::expect_order("over-prediction in h / B", {1.0 / 6, 1.0 / 10, 1.0 / 20}, over,
                                        {0.7, 1.3, "an edge known to a cell; a load off by 0.5 % moves it by 0.2"});
    test::report("load over (2 + pi) c without spacing", fit.limit + 1, 1, 0.03, "settlement 1 %, waves 2 %");
    EXPECT_NEAR(fit.limit, 0, 0.03);
}

/// phi = 20 degrees, c = 0, weightless under a surcharge: N_q times the surcharge if psi = phi; if psi = 0, between
/// this load for Davis' angle and for phi.
TYPED_TEST(FootingSlow, SurchargedSandCarriesReissnersLoad)
{
    const auto n_q = [](double tan)
    { return std::exp(std::numbers::pi * tan) * std::pow(tan + std::sqrt(1 + tan * tan), 2); };
    constexpr double phi = 20 * std::numbers::pi / 180, surcharge = 1000;
    const double     exact = n_q(std::tan(phi)), davis = n_q(std::sin(phi));
    const auto       limit = [&](double dilation)
    {
        test::Footing footing;
        footing.soil       = fmt::format("model = \"mohr-coulomb\"\nyoung = 2.0e6\nfriction_angle_deg = 20.0\n"
                                               "dilation_angle_deg = {}",
                                         dilation);
        footing.reach      = 3.5;
        footing.depth      = 1.5;
        footing.settlement = 0.025;
        footing.speed      = 0.01;
        footing.pic_rate   = 0.1; // without it, grains without weight or cohesion oscillate indefinitely
        footing.surcharge  = surcharge;
        double over[2];
        for (const int cells : {3, 5})
        {
            footing.cells   = cells;
            over[cells / 4] = push(this->exec(), fmt::format("surcharge, psi = {}", dilation), footing) / surcharge;
        }
        return test::at_infinitely_many(3, over[0], 5, over[1]);
    };
    const double associated = limit(20), isochoric = limit(0), tolerance = 0.06;
    test::report("N_q, psi = phi", associated, exact, tolerance * exact, "second order, settlement, waves");
    EXPECT_NEAR(associated, exact, tolerance * exact);
    test::report("N_q, psi = 0", isochoric, 0.5 * (davis + exact), 0.5 * (exact - davis) + tolerance * exact,
                 "from Davis' angle to psi = phi, and as much");
    EXPECT_GT(isochoric, davis - tolerance * exact);
    EXPECT_LT(isochoric, exact * (1 + tolerance));
}

/// Load on dry sand at B/10, as measured.
struct DryLoad
{
    const char* volume_strain;
    double      at_ten_cells; ///< Pa
};

/// phi = 30 degrees, psi = 0, c = 0, rough, loaded by weight only: between the load for Davis' angle of 26.57 degrees
/// and the associated load (Martin 2005). The N_gamma load scales with the square of the width, which is B + O(h): its
/// root is of first order.
TYPED_TEST(FootingSlow, DrySandWithEitherVolumeStrain)
{
    test::Footing footing;
    footing.soil       = "model = \"mohr-coulomb\"\nyoung = 2.0e6\nfriction_angle_deg = 30.0";
    footing.density    = 1600;
    footing.weight     = 1600 * 9.8;
    footing.reach      = 3;
    footing.depth      = 1.5;
    footing.settlement = 0.025;
    footing.speed      = 0.005;
    // gamma B / 2 times N_gamma: 14.75 at 30 degrees, 8.40 at 26.57 (log-linear between 6.491 at 25 and 14.75); the
    // settlement acts as a surcharge, with N_q = 18.4.
    const double half = 0.5 * footing.weight * footing.width, davis = 8.40 * half,
                 associated = 14.75 * half + 18.4 * footing.weight * footing.settlement * footing.width;
    for (const DryLoad& expected : {DryLoad{"cell-average", 11170}, DryLoad{"point", 13530}})
    {
        footing.volume_strain = expected.volume_strain;
        double load[2];
        for (const int cells : {3, 5})
        {
            footing.cells   = cells;
            load[cells / 4] = push(this->exec(), "dry sand", footing);
        }
        const double      limit = std::pow(test::at_infinitely_many(3, std::sqrt(load[0]), 5, std::sqrt(load[1])), 2);
        const std::string of    = std::string(expected.volume_strain) + ": load in Pa ";
        test::report(of + "at B/10", load[1], expected.at_ten_cells, 0.05 * expected.at_ten_cells,
                     fmt::format("known error of the edge, to 5 %: {:+.0f} % of associated flow's",
                                 100 * load[1] / associated - 100));
        EXPECT_NEAR(load[1], expected.at_ten_cells, 0.05 * expected.at_ten_cells);
        test::report(
            of + "without spacing, lowest allowed " + std::to_string(davis), limit, 0.5 * (davis + associated),
            0.5 * (associated - davis),
            "docs/verification.md#strip-footing: the band from Davis to associated, of two spacings and first order");
        EXPECT_GT(limit, davis);
        EXPECT_LT(limit, associated);
    }
}

} // namespace
