#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "energy_balance.hpp"

// Gravity and friction that change from one phase to the next (docs/phases.md#gravity-contacts-scaled-inertia).
namespace phase_settings_test
{

using namespace tread;

constexpr double g = 9.81, degree = std::numbers::pi / 180;

template<class Exec>
class PhaseSettings : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(PhaseSettings, test::Backends, test::BackendNames);

/// Gravity on ground that falls along x by `degrees`.
std::string down(double degrees)
{
    return fmt::format("[{}, 0.0, {}]", g * std::sin(degrees * degree), -g * std::cos(degrees * degree));
}

/// A flat plate on the floor, 0.2 m long, that a slope of 20 degrees does not move before its friction falls.
std::string plate_text()
{
    return fmt::format(R"(
title = "plate on ground that tilts"
[domain]
size    = [2.0, 1.0, 1.0]
gravity = {}
walls   = {{ x = "open", y = "open", bottom = "fixed", top = "open" }}
[[contact]]
between     = ["steel", "wall"]
friction    = 0.6
restitution = 0.1
[[material]]
name  = "steel"
model = "elastic"
young = 1.0e7
[[shape]]
name     = "plate"
generate = {{ kind = "box", size = [0.2, 0.2, 0.04] }}
[[body]]
name     = "plate"
shape    = "plate"
material = "steel"
mass     = 4.0
position = [0.5, 0.5, 0.02]
[[phase]]
name     = "lie"
damping  = 0.3
duration = 0.1
[[phase]]
name     = "tilt"
duration = 0.2
gravity  = {}
[[phase]]
name     = "slide"
duration = 0.2
contacts = [ {{ between = ["wall", "steel"], friction = 0.2 }} ]
)",
                       down(0), down(20));
}

TYPED_TEST(PhaseSettings, APlateSlidesWhenItsFrictionFalls)
{
    test::Experiment<TypeParam> run(this->exec(), plate_text());
    double                      held = 0, start = 0, fallen = 0, off = 0;
    run.run(
        [&](double time)
        {
            const solver::EnergyRow row = run.simulation().ledger().energy(run.simulation().census());
            if (start == 0) { start = row.total; }
            off    = std::max(off, std::abs(row.total - start));
            fallen = start - row.gravity;
            if (time < 0.3) { held = run.simulation().named_bodies()[0].velocity[0]; }
        });
    const double expected = g * (std::sin(20 * degree) - 0.2 * std::cos(20 * degree)) * 0.2;
    const double slid     = run.simulation().named_bodies()[0].velocity[0];
    test::report("speed before its friction falls, m/s", held, 0, 0.01 * expected,
                 "tan 20 degrees = 0.36 is below 0.6; the springs of the contact swing");
    EXPECT_NEAR(held, 0, 0.01 * expected);
    test::report("speed after it, m/s", slid, expected, 0.01 * expected,
                 "m g (sin - mu cos); the springs of the contact let go within a period of 4 ms");
    EXPECT_NEAR(slid, expected, 0.01 * expected);
    test::report("energy unaccounted over that of the fall", off / fallen, 0, test::closes,
                 "that of all scenes; before the fall there are only the 10 uJ of the contact's springs");
    EXPECT_LT(off, test::closes * fallen);
}

/// A ball that flies, in a fixed step of one substep; gravity turns to +x after 0.1 s.
constexpr double flight_dt = 1e-3;

std::string flight_text()
{
    return fmt::format(R"(
title = "gravity turns under a ball in flight"
[domain]
size    = [4.0, 1.0, 4.0]
gravity = {}
walls   = {{ x = "open", y = "open", bottom = "fixed", top = "open" }}
[time]
dt       = {}
substeps = 1
[[material]]
name  = "steel"
model = "elastic"
young = 1.0e9
[[shape]]
name     = "ball"
generate = {{ kind = "sphere" }}
[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
diameter = 0.2
mass     = 10.0
position = [1.0, 0.5, 2.0]
velocity = [3.0, 0.0, 2.0]
[[phase]]
name     = "fly"
duration = 0.1
[[phase]]
name     = "turn"
duration = 0.1
gravity  = [{}, 0.0, 0.0]
)",
                       down(0), flight_dt, g);
}

/// Velocities are half a substep older than the turn: docs/transfers.md#the-energy-balance.
TYPED_TEST(PhaseSettings, ATurnOfGravityLeavesHalfASubstepOfItsPowerUnaccounted)
{
    test::Experiment<TypeParam> run(this->exec(), flight_text());
    double                      first = 0, before = 0, after = 0;
    Vec3<double>                velocity = Vec3<double>::Zero();
    run.run(
        [&](double time)
        {
            const double total = run.simulation().ledger().energy(run.simulation().census()).total;
            if (first == 0) { first = total; }
            if (time > 0.1 + 0.5 * flight_dt)
            {
                after = total;
                return;
            }
            before   = total;
            velocity = run.simulation().named_bodies()[0].velocity;
        });
    const double expected = 0.5 * flight_dt * 10 * Vec3<double>(g, 0, g).dot(velocity), tolerance = 1e-8;
    test::report("change of the total in flight, J", before - first, 0, tolerance, "rounding of some 250 J");
    EXPECT_NEAR(before, first, tolerance);
    test::report("change of the total at the turn, J", after - before, expected, tolerance, "likewise");
    EXPECT_NEAR(after - before, expected, tolerance);
    EXPECT_GT(expected, 0.1);
}

/// An elastic block on a floor without friction, at rest under its weight.
std::string block_text(const std::string& more)
{
    return fmt::format(R"(
title = "block of sand on ground that tilts"
[domain]
size    = [1.6, 0.1, 0.4]
gravity = {}
walls   = {{ x = "open", y = "slip", bottom = "slip", top = "open" }}
[grid]
spacing = 0.05
[numerics]
precision = "double"
[[material]]
name    = "sand"
model   = "elastic"
density = 1600.0
young   = 1.0e6
poisson = 0.0
[[terrain]]
material = "sand"
region   = {{ box = [[0.2, 0.0, 0.0], [0.6, 0.1, 0.2]] }}
[[phase]]
name     = "lie"
duration = 0.3
[[phase]]
name     = "tilt"
duration = 0.2
gravity  = {}
{})",
                       down(0), down(10), more);
}

TYPED_TEST(PhaseSettings, ABlockOfPointsSlidesWhenTheGroundTilts)
{
    test::Experiment<TypeParam> run(this->exec(), block_text(""));
    const double                energy   = test::largest_unaccounted(run);
    const solver::SandCensus    sand     = run.simulation().census().sand;
    const double                expected = g * std::sin(10 * degree) * 0.2, speed = sand.momentum[0] / sand.mass;
    run.simulation().ledger().balance(run.simulation().census());
    const double momentum = run.simulation().ledger().errors().momentum;
    test::report("speed, m/s", speed, expected, 1e-10, "momentum is conserved to rounding in fp64");
    EXPECT_NEAR(speed, expected, 1e-10);
    test::report("energy unaccounted", energy, 0, test::closes, "that of all scenes");
    EXPECT_LT(energy, test::closes);
    test::report("momentum unaccounted over weight and time", momentum, 0, 1e-10, "rounding in fp64");
    EXPECT_LT(momentum, 1e-10);
}

/// Sand that sleeps feels its weight again when gravity turns.
TYPED_TEST(PhaseSettings, SleepingSandWakesWhenTheGroundTilts)
{
    test::Experiment<TypeParam> run(this->exec(), block_text("[sleep]\ndistance = 0.2\nrest = 0.02\nspeed = 0.01\n"));
    std::int64_t                asleep = 0, late = 0;
    run.run(
        [&](double time)
        {
            auto&              sand       = run.simulation().sand();
            const std::int64_t sleepers   = sand.count() - sand.view().count;
            (time <= 0.3 ? asleep : late) = sleepers;
        });
    const solver::SandCensus sand     = run.simulation().census().sand;
    const double             expected = g * std::sin(10 * degree) * 0.2, speed = sand.momentum[0] / sand.mass;
    const auto               all = static_cast<double>(run.simulation().sand().count());
    test::report("share asleep before the tilt", static_cast<double>(asleep) / all, 1, 0, "all of it is at rest");
    EXPECT_EQ(asleep, run.simulation().sand().count());
    test::report("share asleep at the end", static_cast<double>(late) / all, 0, 0, "all of it slides");
    EXPECT_EQ(late, 0);
    test::report("speed, m/s", speed, expected, 1e-10, "as without sleep");
    EXPECT_NEAR(speed, expected, 1e-10);
}

} // namespace phase_settings_test
