#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "backend.hpp"
#include "scene_text.hpp"
#include "solver/bodies/body_commands.hpp"

// Commands of named bodies on a BodyState alone, without pairs, steps or reports.
namespace
{

using namespace tread;

/// A ball that the scene throws along x.
const std::string thrown_ball = test::steel_text + R"(
[time]
dt       = 1.0e-3
substeps = 10
[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
diameter = 0.1
density  = 7800.0
position = [1.0, 0.5, 0.5]
velocity = [3.0, 0.0, 0.0]
[[phase]]
name     = "go"
duration = 0.01
)";

template<class Exec>
class BodyCommandsOnState : public test::BackendTest<Exec>
{
protected:
    void SetUp() override
    {
        test::BackendTest<Exec>::SetUp();
        if (this->IsSkipped()) { return; }
        state_.emplace(this->exec(), scene_, world_, solver::make_plan(scene_, world_), nullptr);
    }

    bool apply(const solver::BodyCommand& command) { return solver::apply_commands(*state_, commands_, {command}); }

    Vec3<double> velocity() { return read(this->exec(), state_->view().velocity); }

    scene::Scene                           scene_ = test::load_text(thrown_ball);
    world::World                           world_ = world::build_world(scene_);
    std::optional<solver::BodyState<Exec>> state_;
    solver::BodyCommands                   commands_{1};
};
TYPED_TEST_SUITE(BodyCommandsOnState, test::Backends, test::BackendNames);

solver::BodyCommand held() { return {dem::lock_all, {}, {}}; }

solver::BodyCommand lowered(double speed)
{
    solver::BodyCommand command = held();
    command.lowering            = {0, 0, -speed};
    return command;
}

/// A body at rest that is driven gets m v of impulse and m v^2/2 + I w^2/2 of work, once.
TYPED_TEST(BodyCommandsOnState, DriveIsAccountedForOnce)
{
    constexpr double    speed = 0.5, spin = 4; // m/s, rad/s
    solver::BodyCommand drive{dem::lock_all, spin, speed};
    ASSERT_TRUE(this->apply(drive));
    EXPECT_FALSE(this->apply(drive)) << "the same command changes nothing";

    const double                mass    = this->world_.bodies.mass.front();
    const double                inertia = full(read(this->exec(), this->state_->view().inertia))(1, 1);
    const solver::CommandTotals totals  = this->commands_.take_totals();
    const double                work = 0.5 * mass * speed * speed + 0.5 * inertia * spin * spin, impulse = mass * speed;
    const double                rounding = 1e-14; // relative: sums of three products
    std::printf("work %.17g J, expected %.17g; impulse %.17g N s, expected %.17g; tolerance %g of each, rounding\n",
                totals.work, work, totals.impulse[0], impulse, rounding);
    EXPECT_NEAR(totals.work, work, rounding * work);
    EXPECT_NEAR(totals.impulse[0], impulse, rounding * impulse);
    EXPECT_EQ(totals.impulse[1], 0);
    EXPECT_EQ(totals.impulse[2], 0);
    EXPECT_EQ(this->commands_.take_totals().work, 0) << "taken before";
}

/// The largest speed is that of the surface: |v| and |w| times the bounding radius.
TYPED_TEST(BodyCommandsOnState, LargestSpeedIsThatOfTheSurface)
{
    constexpr double speed = 0.5, spin = 4; // m/s, rad/s
    ASSERT_TRUE(this->apply({dem::lock_all, spin, speed}));
    EXPECT_DOUBLE_EQ(this->commands_.largest_speed, speed + spin * this->state_->tables.smallest_radius);
}

TYPED_TEST(BodyCommandsOnState, FirstReleaseGivesTheScenesVelocity)
{
    EXPECT_FALSE(this->apply(held())) << "bodies begin held";
    ASSERT_TRUE(this->apply({}));
    EXPECT_EQ(this->velocity(), Vec3<double>(3, 0, 0));
    ASSERT_TRUE(this->apply(held()));
    ASSERT_TRUE(this->apply({}));
    EXPECT_EQ(this->velocity(), Vec3<double>(0, 0, 0)) << "released for the second time";
}

TYPED_TEST(BodyCommandsOnState, LoweredBodyIsReleasedAtRest)
{
    ASSERT_TRUE(this->apply(lowered(0.1)));
    EXPECT_EQ(this->velocity(), Vec3<double>(0, 0, -0.1));
    ASSERT_TRUE(this->apply({}));
    EXPECT_EQ(this->velocity(), Vec3<double>(0, 0, 0));
}

/// The heaviest share is that of the present commands, not of earlier ones.
TYPED_TEST(BodyCommandsOnState, HeaviestShareIsThePresentOne)
{
    solver::BodyCommand loaded;
    loaded.weight = 2.5;
    this->apply(loaded);
    EXPECT_EQ(this->commands_.heaviest, 2.5);
    EXPECT_EQ(read(this->exec(), this->state_->view().weight), 2.5);
    this->apply({});
    EXPECT_EQ(this->commands_.heaviest, 1);
}

} // namespace
