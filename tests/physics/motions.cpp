#include <array>
#include <cmath>
#include <fstream>
#include <numbers>

#include <fmt/format.h>

#include "energy_balance.hpp"
#include "scene/time_table.hpp"

// Prescribed motions of bodies against closed forms, with the energy balance.
namespace
{

using namespace tread;

template<class Exec>
class Motions : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Motions, test::Backends, test::BackendNames);

constexpr double rounding = 1e-10; ///< relative, of some 10^4 steps in fp64
constexpr double g        = 9.81;

/// A drum of 10 kg, 0.2 m across, high above the floor, and one phase.
std::string drum_text(double gravity, double dt, const std::string& body, const std::string& phase)
{
    return fmt::format(R"(
title = "drum with a prescribed motion"
[domain]
size    = [4.0, 1.0, 4.0]
gravity = [0.0, 0.0, {}]
walls   = {{ x = "open", y = "open", bottom = "fixed", top = "open" }}
[time]
dt = {}
[[material]]
name  = "steel"
model = "elastic"
young = 1.0e9
[[shape]]
name      = "drum"
generate  = {{ kind = "wheel", radius = 0.1, width = 0.1, wall_thickness = 0.04, grousers = 0, grouser_height = 0.0 }}
sdf_cells = 32
node_spacing = 0.0125
[[body]]
name     = "drum"
shape    = "drum"
material = "steel"
mass     = 10.0
position = [1.0, 0.5, 2.0]
{}
[[phase]]
name = "move"
{}
)",
                       -gravity, dt, body, phase);
}

std::string motion(double duration, const std::string& axes)
{
    return fmt::format("duration = {}\nmotion = [ {{ body = \"drum\", {} }} ]\n", duration, axes);
}

/// kg m2, moment of inertia of the first body about its axle.
template<class Exec>
double axle_inertia(const test::Experiment<Exec>& run)
{
    const auto& bodies = run.world().bodies;
    const auto& unit   = run.world().templates[static_cast<std::size_t>(bodies.shape[0])].unit;
    return unit.inertia(1, 1) * bodies.mass[0] / unit.volume * bodies.scale[0] * bodies.scale[0];
}

template<class Exec>
solver::BodyRow drum(test::Experiment<Exec>& run)
{
    return run.simulation().named_bodies()[0];
}

/// Runs to the end; expects that energy and momentum are accounted for to rounding.
template<class Exec>
void expect_balance(test::Experiment<Exec>& run)
{
    const double energy = test::largest_unaccounted(run);
    run.simulation().ledger().balance(run.simulation().census());
    const double momentum = run.simulation().ledger().errors().momentum;
    test::report("unaccounted energy", energy, 0, rounding, "rounding in fp64: the work of a reaction is exact");
    EXPECT_LT(energy, rounding);
    test::report("unaccounted momentum over weight and time", momentum, 0, rounding, "rounding in fp64");
    EXPECT_LT(momentum, rounding);
}

TYPED_TEST(Motions, AForceAcceleratesLikeFreeFall)
{
    constexpr double            force = 30, dt = 1e-3, span = 0.5, mass = 10;
    test::Experiment<TypeParam> run(this->exec(), drum_text(g, dt, "", motion(span, "x = { force = 30.0 }")));
    expect_balance(run);
    const solver::BodyRow row = drum(run);
    const double          v = force / mass * span, way = 0.5 * v * span, fallen = 0.5 * g * span * span;
    test::report("velocity along x, m/s", row.velocity[0], v, rounding * v, "rounding: the impulse is exact");
    EXPECT_NEAR(row.velocity[0], v, rounding * v);
    test::report("way along x, m", row.position[0] - 1, way, 0.5 * dt * v + rounding,
                 "symplectic Euler: half a step of the velocity");
    EXPECT_NEAR(row.position[0] - 1, way, 0.5 * dt * v + rounding);
    test::report("fall, m", 2 - row.position[2], fallen, 0.5 * dt * g * span + rounding, "likewise");
    EXPECT_NEAR(2 - row.position[2], fallen, 0.5 * dt * g * span + rounding);
    test::report("reaction along x, N", row.reaction_force[0], force, rounding * force, "the force itself");
    EXPECT_NEAR(row.reaction_force[0], force, rounding * force);
}

TYPED_TEST(Motions, ARampOfForceGivesItsWholeImpulse)
{
    // 10 N to 40 N in 0.2 s, then 40 N for 0.1 s: 5 + 4 N s.
    test::Experiment<TypeParam> run(
        this->exec(), drum_text(0, 3e-3, "", motion(0.3, "y = { force = 40.0, ramp = 0.2, from = 10.0 }")));
    run.run();
    const double impulse = 10 * drum(run).velocity[1];
    // One step holds the kink of the ramp: the force at its middle misses at most slope dt^2 / 8.
    test::report("impulse, N s", impulse, 9, 150 * 9e-6 / 8, "the step with the kink of the ramp");
    EXPECT_NEAR(impulse, 9, 150 * 9e-6 / 8);
}

TYPED_TEST(Motions, ATorqueSpinsAWheelUp)
{
    constexpr double            torque = 0.5, span = 0.4;
    test::Experiment<TypeParam> run(
        this->exec(),
        drum_text(g, 1e-3, "", motion(span, "z = \"held\", roll = \"held\", yaw = \"held\", axle = { torque = 0.5 }")));
    expect_balance(run);
    const double          expected = torque * span / axle_inertia(run);
    const solver::BodyRow row      = drum(run);
    test::report("spin, rad/s", row.angular_velocity[1], expected, rounding * expected, "rounding: T t / I is exact");
    EXPECT_NEAR(row.angular_velocity[1], expected, rounding * expected);
    test::report("reaction about the axle, N m", row.reaction_torque[1], torque, rounding, "the torque itself");
    EXPECT_NEAR(row.reaction_torque[1], torque, rounding);
    test::report("reaction that holds it, N", row.reaction_force[2], 10 * g, rounding * 10 * g, "its weight");
    EXPECT_NEAR(row.reaction_force[2], 10 * g, rounding * 10 * g);
}

TYPED_TEST(Motions, TheFrictionOfABearingStopsAWheelAndHoldsIt)
{
    // Spins up with 0.5 N m less 0.2 N m of friction, runs down by friction, and stands.
    const std::string bearing = "z = \"held\", roll = \"held\", yaw = \"held\", axle_friction = 0.2";
    const std::string phases = motion(0.2, bearing + ", axle = { torque = 0.5 }") + "[[phase]]\nname = \"run_down\"\n" +
                               motion(0.2, bearing) + "[[phase]]\nname = \"stand\"\n" +
                               motion(0.5, bearing + ", axle = { torque = 0.15 }");
    test::Experiment<TypeParam> run(this->exec(), drum_text(g, 1e-3, "", phases));
    const double inertia = axle_inertia(run), top = 0.3 * 0.2 / inertia, later = top - 0.2 * 0.2 / inertia;
    double       fastest = 0, at_end_of_run_down = 0;
    run.run(
        [&](double time)
        {
            const double spin = drum(run).angular_velocity[1];
            fastest           = std::max(fastest, spin);
            if (time < 0.4005) { at_end_of_run_down = spin; }
        });
    // At the end: in the first steps the rounding of 200 J of weight is large beside the energy that changed hands.
    const double lost        = run.simulation().ledger().energy(run.simulation().census()).friction;
    const double unaccounted = std::abs(run.simulation().ledger().errors().energy);
    test::report("spin after 0.5 - 0.2 N m for 0.2 s, rad/s", fastest, top, rounding * top, "exact but for rounding");
    EXPECT_NEAR(fastest, top, rounding * top);
    test::report("spin after 0.2 N m of friction for 0.2 s, rad/s", at_end_of_run_down, later, rounding * top, "exact");
    EXPECT_NEAR(at_end_of_run_down, later, rounding * top);
    test::report("spin under less torque than friction, rad/s", drum(run).angular_velocity[1], 0, rounding,
                 "friction holds it");
    EXPECT_NEAR(drum(run).angular_velocity[1], 0, rounding);
    test::report("unaccounted energy", unaccounted, 0, rounding, "rounding: friction counts as such");
    EXPECT_LT(unaccounted, rounding);
    EXPECT_GT(lost, 0.5 * inertia * top * top);
}

TYPED_TEST(Motions, AVelocityTableIsFollowed)
{
    const test::TemporaryDirectory folder;
    const std::string              path = folder.path("way.csv");
    std::ofstream(path) << "time,unused,v\n-1,0,0\n0.0,1,0.0\n0.1,1,1.0\n0.25,2,-0.5\n0.4,3,0.75\n";
    test::Experiment<TypeParam> run(
        this->exec(), drum_text(g, 1.3e-3, "",
                                motion(0.4, fmt::format("x = {{ velocity = {{ table = \"{}\", column = \"v\" }} }}, "
                                                        "y = \"held\", z = \"held\"",
                                                        path))));
    const scene::TimeTable& table = *run.scene().phases[0].motion[0].translation[0].course.table;
    double                  worst = 0, unaccounted = 0;
    run.run(
        [&](double time)
        {
            worst = std::max(worst, std::abs(drum(run).velocity[0] - scene::value_at(table, time)));
            run.simulation().ledger().energy(run.simulation().census());
            unaccounted = std::max(unaccounted, std::abs(run.simulation().ledger().errors().energy));
        });
    test::report("velocity less the table's, m/s", worst, 0, 0, "it is set to it");
    EXPECT_EQ(worst, 0);
    EXPECT_NEAR(drum(run).velocity[0], 0.75, 1e-12);
    test::report("unaccounted energy", unaccounted, 0, rounding, "rounding in fp64");
    EXPECT_LT(unaccounted, rounding);
}

/// Impulses since the start at the rows of a table, by hand: N s.
struct Impulses
{
    double time, push, load;
};

/// Rows of the table are ends of steps, in which a force acts with its value at mid-step: its impulse is exact.
TYPED_TEST(Motions, ForceAndLoadOfATableGiveTheirImpulses)
{
    const test::TemporaryDirectory folder;
    const std::string              path = folder.path("forces.csv");
    std::ofstream(path) << "time,push,load\n0,0,98.1\n0.1,40,50\n0.3,-20,50\n0.4,-20,120\n";
    const std::array<Impulses, 3> rows{{{0.1, 2, 7.405}, {0.3, 4, 17.405}, {0.4, 2, 25.905}}};
    test::Experiment<TypeParam>   run(
          this->exec(),
          drum_text(g, 1e-3, "",
                    motion(0.4, fmt::format("x = {{ force = {{ table = \"{0}\", column = \"push\" }} }}, y = "
                                              "\"held\", load = {{ force = {{ table = \"{0}\", column = "
                                              "\"load\" }} }}",
                                            path))));
    std::size_t met = 0;
    run.run(
        [&](double time)
        {
            if (met == rows.size() || time < rows[met].time - 1e-9) { return; }
            const Vec3<double> momentum = 10 * drum(run).velocity;
            const Impulses     row      = rows[met++];
            test::report("momentum along x, N s", momentum[0], row.push, 1e-9, "rounding of 400 steps");
            test::report("momentum along z, N s", momentum[2], -row.load, 1e-9, "likewise");
            EXPECT_NEAR(momentum[0], row.push, 1e-9);
            EXPECT_NEAR(momentum[2], -row.load, 1e-9);
        });
    EXPECT_EQ(met, rows.size());
    run.simulation().ledger().energy(run.simulation().census());
    const double       unaccounted = std::abs(run.simulation().ledger().errors().energy), up = 10 * g - 25.905 / 0.4;
    const Vec3<double> reaction = drum(run).reaction_force;
    test::report("mean reaction along x, N", reaction[0], 5, 1e-7, "2 N s in 0.4 s");
    test::report("mean reaction along z, N", reaction[2], up, 1e-7, "the weight less the mean load");
    EXPECT_NEAR(reaction[0], 5, 1e-7);
    EXPECT_NEAR(reaction[2], up, 1e-7);
    test::report("unaccounted energy", unaccounted, 0, rounding, "rounding in fp64");
    EXPECT_LT(unaccounted, rounding);
}

TYPED_TEST(Motions, AYawedBodyIsTowedAlongItsOwnAxes)
{
    // Turned by a quarter about z in the first phase; then its own x is the world's y.
    const double      rate = std::numbers::pi / 2 / 0.1;
    const std::string phases =
        motion(0.1, fmt::format("x = \"held\", y = \"held\", z = \"held\", roll = \"held\", "
                                "pitch = \"held\", yaw = {{ velocity = {} }}",
                                rate)) +
        "[[phase]]\nname = \"tow\"\n" +
        motion(0.2,
               "frame = \"body\", rotation_frame = \"body\", x = { velocity = 0.5 }, y = \"held\", z = \"held\", roll "
               "= \"held\", pitch = \"held\", yaw = \"held\"");
    test::Experiment<TypeParam> run(this->exec(), drum_text(g, 1e-3, "", phases));
    expect_balance(run);
    const solver::BodyRow row = drum(run);
    const Vec3<double>    way = row.position - Vec3<double>(1, 0.5, 2), expected(0, 0.1, 0);
    test::report("way less 0.1 m along y, m", (way - expected).norm(), 0, 1e-9, "rounding of a hundred rotations");
    EXPECT_NEAR((way - expected).norm(), 0, 1e-9);
    test::report("spin, rad/s", row.angular_velocity.norm(), 0, rounding, "held");
    EXPECT_NEAR(row.angular_velocity.norm(), 0, rounding);
}

TYPED_TEST(Motions, ACarriageSwingsAtItsFrequencyAndDecay)
{
    // 10 kg on 4000 N/m: 20 rad/s; 40 N s/m are a tenth of critical damping. The weight presses it down by m g / k.
    constexpr double mass = 10, stiffness = 4000, damping = 40, dt = 1e-4, away = 0.05;
    const double     rest = 2 - away - mass * g / stiffness;
    const auto       text = drum_text(
              g, dt, "",
              motion(1.0,
                     fmt::format("x = \"held\", y = \"held\", carriage = {{ stiffness = {}, damping = {}, height = {} }}",
                                 stiffness, damping, 2 - away)));
    const double decay = damping / (2 * mass), frequency = std::sqrt(stiffness / mass - decay * decay),
                 start = 2 - rest;
    test::Experiment<TypeParam> run(this->exec(), text);
    double                      worst = 0;
    run.run(
        [&](double time)
        {
            const double swing = start * std::exp(-decay * time) *
                                 (std::cos(frequency * time) + decay / frequency * std::sin(frequency * time));
            worst = std::max(worst, std::abs(drum(run).position[2] - rest - swing) / start);
        });
    // At the end: in the first steps the rounding of 200 J of weight is large beside the energy that changed hands.
    run.simulation().ledger().energy(run.simulation().census());
    const double unaccounted = std::abs(run.simulation().ledger().errors().energy);
    // Velocities are half a step older than places: the swing lags by up to half a step, 20 rad/s x 0.05 ms.
    test::report("place less the closed form, over the swing", worst, 0, 1.5e-3, "half a step of phase, 1e-3");
    EXPECT_LT(worst, 1.5e-3);
    test::report("unaccounted energy", unaccounted, 0, rounding, "rounding in fp64");
    EXPECT_LT(unaccounted, rounding);
}

TYPED_TEST(Motions, AStopEndsThePhase)
{
    const std::string text =
        drum_text(0, 1e-3, "",
                  motion(1.0, "x = { velocity = 0.5 }, y = \"held\", z = \"held\", until = { displacement_x = 0.1 }"));
    test::Experiment<TypeParam> run(this->exec(), text);
    run.run();
    EXPECT_EQ(run.phase_end().kind, tread::run::EndKind::stopped);
    test::report("way at the end, m", drum(run).position[0] - 1, 0.1, 8 * 0.5e-3 + 1e-9,
                 "at the first measured step at or past it: eight steps at most");
    EXPECT_NEAR(drum(run).position[0] - 1, 0.1, 8 * 0.5e-3 + 1e-9);
    EXPECT_GE(drum(run).position[0] - 1, 0.1);

    test::Experiment<TypeParam> missed(this->exec(), test::load_text(text, {"phase.move.duration=0.1"}));
    missed.run();
    EXPECT_EQ(missed.phase_end().kind, tread::run::EndKind::unstopped);
}

/// The roller of roller_text without its lock, with phases.
std::string roller(const std::string& phases)
{
    std::string text = test::roller_text;
    const auto  lock = text.find("lock     =");
    text.erase(lock, text.find('\n', lock) - lock);
    const auto first = text.find("[[phase]]"), end = text.find("[output]");
    return text.replace(first, end - first, phases);
}

TYPED_TEST(Motions, WhatHoldsABodyOnTheBedCarriesTheRestOfItsWeight)
{
    const std::string           still = "x = \"held\", y = \"held\", roll = \"held\", pitch = \"held\", yaw = \"held\"";
    test::Experiment<TypeParam> run(
        this->exec(),
        roller(fmt::format("[[phase]]\nname = \"press\"\nduration = 0.3\nmotion = [ {{ body = \"roller\", {0}, z = {{ "
                           "velocity = -0.2 }}, until = {{ force_z = 60.0 }} }} ]\n[[phase]]\nname = \"hold\"\n"
                           "duration = 0.05\nmotion = [ {{ body = \"roller\", {0}, z = \"held\" }} ]\n",
                           still)));
    bool   held = false;
    double end  = 0;
    run.run(
        [&](double time)
        {
            if (!held && drum(run).velocity[2] == 0)
            {
                held = true;
                end  = time;
                run.simulation().begin_mean();
            }
        });
    ASSERT_TRUE(held);
    EXPECT_LT(end, 0.29);
    const solver::BodyRow row    = drum(run);
    const double          weight = 4 * g, sum = row.force[2] + row.reaction_force[2];
    test::report("bed's force, N", row.force[2], 60, 60, "what the stop asked for, as it relaxes: above 0");
    EXPECT_GT(row.force[2], 0);
    test::report("bed's force and the reaction, N", sum, weight, rounding * weight, "nothing moves: rounding");
    EXPECT_NEAR(sum, weight, 1e-9 * weight);
    run.simulation().ledger().balance(run.simulation().census());
    EXPECT_LT(run.simulation().ledger().errors().momentum, rounding);
}

TYPED_TEST(Motions, ADeadWeightReplacesTheWeight)
{
    test::Experiment<TypeParam> run(this->exec(),
                                    drum_text(g, 1e-3, "", motion(0.3, "load = 25.0, x = \"held\", y = \"held\"")));
    expect_balance(run);
    const double v = -2.5 * 0.3;
    test::report("velocity of 10 kg under 25 N, m/s", drum(run).velocity[2], v, rounding, "rounding");
    EXPECT_NEAR(drum(run).velocity[2], v, rounding);
}

/// A drum of 10 kg on a plane with friction.
std::string towed_text(const std::string& phase)
{
    std::string text = drum_text(g, 1e-3, "", phase);
    text.replace(text.find("position = [1.0, 0.5, 2.0]"), 26, "position = [1.0, 0.5, 0.1]");
    text.replace(text.find("dt = 0.001"), 10, "dt = \"auto\"");
    return text + "[[contact]]\nbetween = [\"steel\", \"wall\"]\nfriction = 0.8\nrestitution = 0.1\n";
}

TYPED_TEST(Motions, ATowedWheelRollsOnItsRadius)
{
    test::Experiment<TypeParam> run(
        this->exec(),
        towed_text(motion(0.8, "x = { velocity = 0.5, ramp = 0.3 }, y = \"held\", roll = \"held\", yaw = \"held\"")));
    double spin = 0, rows = 0;
    run.run(
        [&](double time)
        {
            if (time < 0.5) { return; }
            spin += drum(run).angular_velocity[1];
            rows += 1;
        });
    const double expected = 0.5 / 0.1;
    test::report("mean spin, rad/s", spin / rows, expected, 0.02 * expected,
                 "the drum is a polygon, which rolls on its edges");
    EXPECT_NEAR(spin / rows, expected, 0.02 * expected);
    const solver::BodyRow row = drum(run);
    EXPECT_NEAR(row.velocity[0], 0.5, 1e-12);
    run.simulation().ledger().balance(run.simulation().census());
    EXPECT_LT(run.simulation().ledger().errors().momentum, rounding);
}

/// Two bodies move at the same time, each by its own motion.
TYPED_TEST(Motions, TwoBodiesMoveEachByItsOwn)
{
    const std::string other =
        "[[body]]\nname = \"other\"\nshape = \"drum\"\nmaterial = \"steel\"\nmass = 5.0\nposition "
        "= [2.0, 0.5, 2.0]\n";
    test::Experiment<TypeParam> run(
        this->exec(),
        drum_text(0, 1e-3, other,
                  "duration = 0.2\nmotion = [ { body = \"drum\", x = { velocity = -0.5 } }, { body = \"other\", z = { "
                  "force = 10.0 }, yaw = { velocity = 3.0 } } ]\n"));
    expect_balance(run);
    const auto bodies = run.simulation().named_bodies();
    EXPECT_DOUBLE_EQ(bodies[0].velocity[0], -0.5);
    EXPECT_NEAR(bodies[1].velocity[2], 10.0 / 5 * 0.2, rounding);
    EXPECT_NEAR(bodies[1].angular_velocity[2], 3, rounding);
}

} // namespace
