#include <cmath>
#include <string>

#include <fmt/format.h>

#include "energy_balance.hpp"

// Rocks as small as the points of the bed under them, with nine samples per point and with one.
namespace pebbles_test
{

using namespace tread;

template<class Exec>
class Pebbles : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Pebbles, test::Backends, test::BackendNames);

template<class Exec>
class FullSizePebbles : public Pebbles<Exec>
{
};
TYPED_TEST_SUITE(FullSizePebbles, test::Backends, test::BackendNames);

constexpr double point_radius = 0.0155; ///< m, of 0.025 m between points
constexpr double pebble_mass  = 0.05;   ///< kg

/// An elastic bed, and a pebble of the points' size at `position` with friction; `form`, `body` and `phase`: lines of
/// their tables.
std::string pebble_on_bed(double refine_below, const std::string& form, const std::string& body,
                          const std::string& phase)
{
    return fmt::format(R"(
title = "pebble"
[domain]
size    = [0.3, 0.3, 0.3]
gravity = [0.0, 0.0, -9.81]
walls   = {{ x = "slip", y = "slip", bottom = "fixed", top = "open" }}
[grid]
spacing = 0.05
[numerics]
precision    = "double"
refine_below = {}
[[material]]
name = "gel"
model = "elastic"
density = 1600.0
young = 1.0e5
poisson = 0.3
[[material]]
name = "stone"
model = "elastic"
density = 2700.0
young = 1.0e7
poisson = 0.3
[[contact]]
between  = ["gel", "stone"]
friction = 0.5
[[terrain]]
material = "gel"
region = {{ box = [[0.0, 0.0, 0.0], [0.3, 0.3, 0.15]] }}
[[shape]]
name = "pebble"
generate = {}
sdf_cells = 32
[[body]]
name     = "pebble"
shape    = "pebble"
material = "stone"
diameter = {}
mass     = {}
{}
[[phase]]
name = "run"
{}
)",
                       refine_below, form, 2 * point_radius, pebble_mass, body, phase);
}

constexpr auto ball = "{ kind = \"sphere\" }";
constexpr auto rock = "{ kind = \"rock\", seed = 3, aspect = 0.6, sphericity = 0.8, nodes = 162 }";

/// In the hollow between four points, a pebble rests on them with its weight and no torque.
TYPED_TEST(Pebbles, RestsInTheHollowWithItsWeight)
{
    for (const double refine_below : {0.0, 3.0})
    {
        test::Experiment<TypeParam> rest(
            this->exec(),
            pebble_on_bed(refine_below, ball, "position = [0.15, 0.15, 0.172]", "duration = 1.2\ndamping = 0.5"));
        bool started = false;
        rest.run(
            [&](double time)
            {
                if (time > 0.8 && !started)
                {
                    rest.simulation().begin_mean();
                    started = true;
                }
            });
        const auto   pebble = rest.simulation().named_bodies().at(0);
        const double weight = pebble_mass * 9.81;
        const auto   label  = fmt::format("refine_below = {}: ", refine_below);
        test::report(
            label + "mean contact force in N", pebble.force[2], weight, 0.01 * weight,
            fmt::format("1 % of the weight, time mean (docs/verification.md#body-at-rest-on-sand); centre at {:.5f} m",
                        pebble.position[2]));
        EXPECT_NEAR(pebble.force[2], weight, 0.01 * weight);
        const double torque = pebble.torque.norm() / (weight * point_radius);
        test::report(label + "torque over weight x radius", torque, 0, 0.01, "1 % as the force, which has that arm");
        EXPECT_LE(torque, 0.01);
    }
}

/// A flat rock strikes, slides and turns. Momentum is exchanged exactly; the difference between the work seen by
/// substeps and by the grid vanishes with the step, and the samples add no error of their own.
template<class Exec>
void expect_balance_of_a_thrown_rock(const Exec& exec, double refine_below)
{
    const auto unaccounted = [&](double dt)
    {
        test::Experiment<Exec> thrown(exec, pebble_on_bed(refine_below, rock,
                                                          "position = [0.1, 0.14, 0.185]\nvelocity = [0.5, 0.2, -1.0]",
                                                          fmt::format("duration = 0.15\n[time]\ndt = {}", dt)));
        const double           error   = test::largest_unaccounted(thrown);
        const auto             census  = thrown.simulation().census();
        auto&                  ledger  = thrown.simulation().ledger();
        const double           impulse = ledger.balance(census).impulse_error;
        test::report("impulse error over weight x time", impulse, 0, 1e-10,
                     "fp64 rounding (docs/verification.md#momentum-balance)");
        EXPECT_LT(impulse, 1e-10);
        const double thrown_energy = 0.5 * pebble_mass * (0.25 + 0.04 + 1.0);
        EXPECT_GT(ledger.energy(census).friction, 0.1 * thrown_energy) << "it never slid";
        return error;
    };
    // The rock touches single points, and which ones depends on the step: orders from neighbouring steps scatter
    // between 0.75 and 1.3, so the order is taken over a factor of eight, and the limit from both ends.
    const double coarse = unaccounted(2.0e-4), fine = unaccounted(0.25e-4);
    const double order = std::log2(coarse / fine) / 3, limit = (8 * fine - coarse) / 7;
    const auto   label = fmt::format("refine_below = {}: unaccounted over the largest energy", refine_below);
    test::report(fmt::format("{}, {:.4g} and {:.4g}: order in dt", label, coarse, fine), order, 1, 0.15,
                 "first order in dt, with the scatter of a halving over three of them");
    EXPECT_NEAR(order, 1, 0.15);
    test::report(label + " that the step does not explain", limit, 0, test::closes, "design 7");
    EXPECT_LT(std::abs(limit), test::closes);
}

TYPED_TEST(Pebbles, EnergyBalanceOfAThrownRockCloses) { expect_balance_of_a_thrown_rock(this->exec(), 3.0); }

/// One sample per point.
TYPED_TEST(FullSizePebbles, EnergyBalanceOfAThrownRockCloses) { expect_balance_of_a_thrown_rock(this->exec(), 0.0); }

} // namespace pebbles_test
