#include <cmath>
#include <cstdio>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/errors.hpp"
#include "harness.hpp"
#include "joint_scenes.hpp"

// Scenes with joints: balances, motors of phases, and runs that are stopped or refused.
namespace
{

using namespace tread;
using ::testing::HasSubstr;

template<class Exec>
class JointScenes : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(JointScenes, test::Backends, test::BackendNames);

TYPED_TEST(JointScenes, BalancesOfASwingingChainClose)
{
    test::Experiment<TypeParam> chain(this->exec(), test::swinging_under_gravity(1.0));
    double                      largest = 0;
    chain.run([&](double) { largest = std::max(largest, std::abs(chain.simulation().named_bodies()[1].velocity[2])); });
    const solver::Census    now    = chain.simulation().census();
    const solver::EnergyRow energy = chain.simulation().ledger().energy(now);
    chain.simulation().ledger().balance(now);
    const io::ErrorReport errors = chain.simulation().ledger().errors();
    test::report("energy unaccounted", errors.energy, 0, 1e-3, "docs/theory.md#energy-balance");
    test::report("impulse unaccounted", errors.momentum, 0, 1e-9, "the world's pull on the pins is an impulse");
    EXPECT_LT(std::abs(errors.energy), 1e-3);
    EXPECT_LT(errors.momentum, 1e-9);
    EXPECT_GT(largest, 1) << "the chain falls";
    EXPECT_NE(energy.work_in, 0);
}

/// kg m2, of a named body about any axis; a ball.
double inertia_of(const world::World& world, std::size_t body)
{
    const auto& unit = world.templates[static_cast<std::size_t>(world.bodies.shape[body])].unit;
    return unit.inertia(1, 1) * world.bodies.mass[body] / unit.volume * std::pow(world.bodies.scale[body], 2);
}

/// The ball has J = 0.4 m r^2 = 0.01 kg m2: the motor needs 0.2 s to get it to 6 rad/s.
TYPED_TEST(JointScenes, MotorTurnsFromItsPhaseOn)
{
    test::Experiment<TypeParam> chain(this->exec(), test::swinging_text(0.1));
    const double                inertia = inertia_of(chain.world(), 2), torque = 0.3;
    double                      held = 0;
    chain.run(
        [&](double time)
        {
            if (time < 0.0101) { held = std::max(held, chain.simulation().named_bodies()[2].angular_velocity.norm()); }
        });
    const double           spin = chain.simulation().named_bodies()[2].angular_velocity[1];
    const solver::JointRow axle = chain.simulation().joints()[2];
    test::report("spin after 0.1 s (rad/s)", spin, 0.1 * torque / inertia, 1e-6, "a constant torque is exact");
    EXPECT_EQ(held, 0);
    EXPECT_NEAR(inertia, 0.01, 5e-4);
    EXPECT_NEAR(spin, 0.1 * torque / inertia, 1e-6);
    EXPECT_GT(axle.motor_torque, 0);
    EXPECT_LE(axle.motor_torque, torque * (1 + 1e-12));
}

/// Energy and momentum that the ledger cannot account for, at most; a row of a joint does no work but by its error.
template<class Exec>
void expect_closed(test::Experiment<Exec>& run)
{
    const solver::Census now = run.simulation().census();
    run.simulation().ledger().energy(now);
    run.simulation().ledger().balance(now);
    const io::ErrorReport errors = run.simulation().ledger().errors();
    test::report("energy unaccounted", errors.energy, 0, 1e-6, "docs/theory.md#energy-balance");
    test::report("momentum unaccounted", errors.momentum, 0, 1e-9, "docs/theory.md#energy-balance");
    EXPECT_LT(std::abs(errors.energy), 1e-6);
    EXPECT_LT(errors.momentum, 1e-9);
}

/// The first ball is led along x and cannot turn: it takes the second along. By the momentum of both, the mean reaction
/// along x is (10 + 10) kg x 0.4 m/s / 0.4 s = 20 N, that along z both weights; and the second ball's weight, 0.2 m
/// from the first, turns it by 10 kg g x 0.2 m about y, which pitch answers with the opposite torque.
TYPED_TEST(JointScenes, AMotionLeadsABodyWithAJoint)
{
    constexpr double            mass = 20, speed = 0.4, span = 0.4, g = 9.81, rounding = 1e-8;
    test::Experiment<TypeParam> run(this->exec(),
                                    test::moved_text(span, "x = { velocity = 0.4, ramp = 0.4 }, y = \"held\", z = "
                                                           "\"held\", roll = \"held\", pitch = \"held\", yaw = "
                                                           "\"held\""));
    run.run();
    const auto          bodies = run.simulation().named_bodies();
    const Vec3<double>& force  = bodies[0].reaction_force;
    test::report("speed of the follower (m/s)", bodies[1].velocity[0], speed, rounding, "its row is solved exactly");
    test::report("reaction along x (N)", force[0], mass * speed / span, rounding, "the momentum of both");
    test::report("reaction along z (N)", force[2], mass * g, 1e-6, "the weight of both");
    test::report("reaction about y (N m)", bodies[0].reaction_torque[1], -10 * g * 0.2, 1e-6, "the weight's moment");
    EXPECT_NEAR(bodies[1].velocity[0], speed, rounding);
    EXPECT_NEAR(force[0], mass * speed / span, rounding);
    EXPECT_NEAR(force[2], mass * g, 1e-6);
    EXPECT_NEAR(bodies[0].reaction_torque[1], -10 * g * 0.2, 1e-6);
    EXPECT_LT(run.simulation().joints()[0].gap, 1e-9);
    expect_closed(run);
}

/// Free along z alone: both balls rise with (300 N - 20 kg g) / 20 kg.
TYPED_TEST(JointScenes, AMotionLiftsABodyWithAJointByAForce)
{
    constexpr double            mass = 20, force = 300, span = 0.2, g = 9.81;
    const double                speed = (force / mass - g) * span;
    test::Experiment<TypeParam> run(this->exec(), test::moved_text(span, "x = \"held\", y = \"held\", z = { force = "
                                                                         "300.0 }, roll = \"held\", pitch = \"held\", "
                                                                         "yaw = \"held\""));
    run.run();
    const auto bodies = run.simulation().named_bodies();
    test::report("velocity of both (m/s)", bodies[0].velocity[2], speed, 1e-9, "the impulse is exact");
    EXPECT_NEAR(bodies[0].velocity[2], speed, 1e-9);
    EXPECT_NEAR(bodies[1].velocity[2], speed, 1e-9);
    expect_closed(run);
}

/// Balls of 0.1 m whose centres are 0.06 m apart: without the joint the scene would be refused.
TYPED_TEST(JointScenes, JointedBodiesDoNotTouch)
{
    std::string       text  = test::moved_text(0.1, "x = { velocity = 0.1 }");
    const std::string apart = "position = [1.2, 0.5, 0.8]";
    text.replace(text.find(apart), apart.size(), "position = [1.06, 0.5, 0.8]");
    test::Experiment<TypeParam> run(this->exec(), text);
    run.run();
    for (const solver::BodyRow& body : run.simulation().named_bodies()) { EXPECT_EQ(body.force.norm(), 0); }
    expect_closed(run);
}

/// A phase that follows turns the motor the other way, with less torque.
TYPED_TEST(JointScenes, APhaseSetsSpeedAndTorqueOfAMotor)
{
    const std::string           text = test::swinging_text(0.1) + R"([[phase]]
name = "back"
duration = 0.05
motors = [ { joint = "axle", speed = -6.0, max_torque = 0.2 } ]
)";
    test::Experiment<TypeParam> chain(this->exec(), text);
    chain.run();
    const double spin     = chain.simulation().named_bodies()[2].angular_velocity[1];
    const double expected = (0.1 * 0.3 - 0.05 * 0.2) / inertia_of(chain.world(), 2);
    test::report("spin after 0.3 N m for 0.1 s and -0.2 N m for 0.05 s", spin, expected, 1e-6, "constant torques");
    EXPECT_NEAR(spin, expected, 1e-6);
}

TYPED_TEST(JointScenes, AJointThatDriftsStopsTheRunByName)
{
    std::string       text = test::swinging_under_gravity(1.0);
    const std::string axis = "stiffness = 2";
    text.replace(text.find(axis), axis.size(), "drift = 1e-12\nstiffness = 2");
    test::Experiment<TypeParam> chain(this->exec(), text);
    try
    {
        chain.run();
        FAIL() << "the run went on";
    }
    catch (const NumericalError& error)
    {
        EXPECT_THAT(error.what(), HasSubstr("joint 'elbow' has an error of"));
        EXPECT_THAT(error.what(), HasSubstr("over its drift of 1e-12"));
    }
}

/// Both stops are struck: the elbow's at -20 degrees, where it would swing to -34, and the pin's at 170.
TYPED_TEST(JointScenes, AJointThatSwingsAgainstItsStopsGoesOn)
{
    constexpr double  stop = -20 * std::numbers::pi / 180;
    std::string       text = test::swinging_under_gravity(1.0);
    const std::string axis = "stiffness = 2";
    text.replace(text.find(axis), axis.size(), "limits_deg = [-20, 20]\nstiffness = 2");
    test::Experiment<TypeParam> chain(this->exec(), text);
    double                      lowest = 0, beyond = 0;
    chain.run(
        [&](double)
        {
            const auto joints = chain.simulation().joints();
            lowest            = std::min(lowest, joints[1].coordinate);
            for (const solver::JointRow& joint : joints) { beyond = std::max(beyond, std::abs(joint.excess)); }
        });
    test::report("lowest angle of the elbow after a step, rad", lowest, stop, 1e-3,
                 "it leaves the stop by less within a step");
    test::report("way beyond a stop, rad", beyond, 0, 5e-7, "(w dt)^2 / 2 in a substep of 5e-5 s, w up to 20 rad/s");
    EXPECT_NEAR(lowest, stop, 1e-3);
    EXPECT_LT(beyond, 5e-7);
}

/// A joint that motions carry beyond a limit.
struct Carried
{
    const char* joint;    ///< its keys
    const char* led;      ///< motion of the first ball
    const char* follower; ///< motion of the second
    double      speed;    ///< of the coordinate towards the limit
    double      limit;    ///< from the start, m or rad
    const char* said;
};

/// Time and way beyond of the message that stops the run.
template<class Exec>
void expect_stop(const Exec& exec, const Carried& carried)
{
    constexpr double dt = 1e-3, substep = 5e-5, drift = 1e-4;
    std::string      text =
        test::moved_text(0.4, fmt::format("{} }}, {{ body = \"follower\", {}", carried.led, carried.follower));
    const std::string weld = "name = \"weld\"\ntype = \"fixed\"", at = "at = [1.1, 0.5, 0.8]";
    text.replace(text.find(at), at.size(), "at = [1.0, 0.5, 0.8]");
    text.replace(text.find(weld), weld.size(), carried.joint);
    test::Experiment<Exec> run(exec, text);
    try
    {
        run.run();
        FAIL() << "the run went on";
    }
    catch (const NumericalError& error)
    {
        double time = 0, beyond = 0;
        EXPECT_THAT(error.what(), HasSubstr(carried.said));
        ASSERT_EQ(std::sscanf(error.what(), "t = %lf s: joint '%*[a-z]' is %lf", &time, &beyond), 2) << error.what();
        const double first = (carried.limit + drift) / carried.speed, end = time + dt,
                     way = carried.speed * end - carried.limit;
        test::report("end of the step of the message, s", end, first, dt + substep,
                     "errors are looked at after each step");
        test::report("way beyond the limit", beyond, way, carried.speed * substep + 5e-3 * way,
                     "as of the start of the last substep; three digits are printed");
        EXPECT_GE(end, first);
        EXPECT_LE(end, first + dt + substep);
        EXPECT_NEAR(beyond, way, carried.speed * substep + 5e-3 * way);
    }
}

TYPED_TEST(JointScenes, AJointThatIsCarriedBeyondItsLimitStopsTheRunByName)
{
    const char* held = "x = \"held\", y = \"held\", z = \"held\", roll = \"held\", pitch = \"held\", yaw = \"held\"";
    expect_stop(this->exec(),
                Carried{"name = \"rail\"\ntype = \"prismatic\"\naxis = [1, 0, 0]\nlimits = [-0.05, 0.1]",
                        "x = { velocity = -0.4 }, y = \"held\", z = \"held\", roll = \"held\", pitch = \"held\", yaw = "
                        "\"held\"",
                        "x = \"held\"", 0.4, 0.1, " m above the high end 0.1 of its limits, over its drift of 0.0001"});
    expect_stop(this->exec(),
                Carried{"name = \"hinge\"\ntype = \"revolute\"\naxis = [0, 1, 0]\nlimits_deg = [-5, 30]",
                        "x = \"held\", y = \"held\", z = \"held\", roll = \"held\", pitch = { velocity = 0.5 }, yaw = "
                        "\"held\"",
                        held, 0.5, 5 * std::numbers::pi / 180,
                        " rad below the low end -5 of its limits_deg, over its drift of 0.0001"});
}

/// The weld leaves the follower no velocity along x but the 0.4 m/s of the ball that leads it.
TEST(JointWorlds, RefuseMotionsThatPullAJointApart)
{
    const std::string led = test::moved_text(0.1, "x = { velocity = 0.4 }, roll = \"held\", pitch = \"held\", yaw = "
                                                  "\"held\" }, { body = \"follower\", x = \"held\"");
    try
    {
        world::build_world(test::load_text(led));
        FAIL() << "the world was built";
    }
    catch (const InputError& error)
    {
        EXPECT_THAT(error.what(), HasSubstr("scene.toml:"));
        EXPECT_THAT(error.what(), HasSubstr("[[phase]] 'move': motion: it pulls [[joint]] 'weld' apart"));
    }
    const std::string alike = test::moved_text(0.1, "x = { velocity = 0.4 }, roll = \"held\", pitch = \"held\", yaw = "
                                                    "\"held\" }, { body = \"follower\", x = { velocity = 0.4 }");
    EXPECT_NO_THROW(world::build_world(test::load_text(alike)));
}

TEST(JointWorlds, RefuseALoopThatIsClosedTwice)
{
    const std::string text = test::swinging_text(0.1) + R"(
[[joint]]
name = "twice"
type = "revolute"
between = ["world", "lower"]
at = [2.9, 0.5, 0.8]
axis = [0, 1, 0]
)";
    try
    {
        world::build_world(test::load_text(text));
        FAIL() << "the world was built";
    }
    catch (const InputError& error)
    {
        EXPECT_THAT(error.what(), HasSubstr("scene.toml:"));
        EXPECT_THAT(error.what(), HasSubstr("[[joint]] 'twice': between: it ties what joints before it tie already"));
    }
}

} // namespace
