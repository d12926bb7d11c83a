#include <fmt/format.h>

#include "energy_balance.hpp"
#include "order.hpp"

// Energy balance of sand and bodies together (design section 7).
namespace
{

using namespace tread;

template<class Exec>
class CouplingEnergy : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(CouplingEnergy, test::Backends, test::BackendNames);

template<class Exec>
class FullSizeCouplingEnergy : public CouplingEnergy<Exec>
{
};
TYPED_TEST_SUITE(FullSizeCouplingEnergy, test::Backends, test::BackendNames);

/// A stone ball of 15 cm, free to turn, that strikes sand at 1 m/s and slides over it; `time`: lines of that table.
std::string ball_on_sand(const std::string& time)
{
    return R"(
title = "ball on sand"
[domain]
size    = [0.4, 0.4, 0.6]
gravity = [0.0, 0.0, -9.81]
walls   = { x = "slip", y = "slip", bottom = "fixed", top = "open" }
[grid]
spacing = 0.05
[numerics]
precision = "double"
[time]
)" + time + R"(
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 30.0
[[material]]
name = "stone"
model = "elastic"
density = 2500.0
young = 1.0e7
poisson = 0.3
[[terrain]]
material = "sand"
region = { box = [[0.0, 0.0, 0.0], [0.4, 0.4, 0.2]] }
[[shape]]
name = "ball"
generate = { kind = "sphere" }
sdf_cells = 32
[[body]]
name = "ball"
shape = "ball"
diameter = 0.15
density = 2500.0
material = "stone"
position = [0.2, 0.2, 0.3]
velocity = [0.3, 0.0, -1.0]
[[phase]]
name = "drop"
duration = 0.15
)";
}

/// With the automatic step, which changes with the contacts, and with many substeps. Momentum is exchanged to rounding,
/// although each impulse acts on the body in its substep and on the sand over the step.
TYPED_TEST(CouplingEnergy, BalanceOfADroppedBallCloses)
{
    for (const std::string time : {"dt = \"auto\"", "dt = 1.0e-3\nsubsteps = 7"})
    {
        test::Experiment<TypeParam> drop(this->exec(), ball_on_sand(time));
        const double                error = test::largest_unaccounted(drop);
        test::report("unaccounted over the largest energy, " + time, error, 0, test::closes, "design 7");
        EXPECT_LT(error, test::closes);
        const double impulse = drop.simulation().ledger().balance(drop.simulation().census()).impulse_error;
        test::report("impulse error over weight x time, " + time, impulse, 0, 1e-10,
                     "fp64 rounding (docs/verification.md#momentum-balance)");
        EXPECT_LT(impulse, 1e-10);
    }
}

/// The difference between the work seen by substeps and by the grid vanishes with the step.
TYPED_TEST(FullSizeCouplingEnergy, CouplingFallsWithTheTimeStep)
{
    const auto coupling = [&](const std::string& dt)
    {
        test::Experiment<TypeParam> drop(this->exec(), ball_on_sand("dt = " + dt));
        drop.run();
        return drop.simulation().ledger().energy(drop.simulation().census()).coupling;
    };
    const auto fit =
        test::expect_order("coupling in dt, J of 4.3 J", {2.5e-4, 1.25e-4, 6.25e-5},
                           {coupling("2.5e-4"), coupling("1.25e-4"), coupling("6.25e-5")},
                           {0.85, 1.05, "first order; a term of -9.4e4 dt^2 J beside 252 dt J takes 0.11"});
    test::report("coupling at no time step in J", fit.limit, 0, 4.3e-3,
                 "0.1 % of 4.3 J: what the term of dt^2 leaves is 0.0016");
    EXPECT_NEAR(fit.limit, 0, 4.3e-3);
}

} // namespace
