#include <cmath>

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
