#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "backend.hpp"
#include "scene_text.hpp"
#include "solver/bodies/dem_solver.hpp"

// Lifetime of a list of pairs, measured by the number of searches.
namespace
{

using namespace tread;

constexpr double radius = 0.05, step = 1e-3; // m, s

/// Two balls, out of each other's reach.
const std::string balls = test::steel_text + R"(
[time]
dt       = 1.0e-3
substeps = 10
[[body]]
name     = "still"
shape    = "ball"
material = "steel"
diameter = 0.1
density  = 7800.0
position = [1.0, 0.5, 0.5]
[[body]]
name     = "thrown"
shape    = "ball"
material = "steel"
diameter = 0.1
density  = 7800.0
position = [2.0, 0.5, 0.5]
[[phase]]
name     = "go"
duration = 0.01
)";

template<class Exec>
class RigidLists : public test::BackendTest<Exec>
{
protected:
    void SetUp() override
    {
        test::BackendTest<Exec>::SetUp();
        if (this->IsSkipped()) { return; }
        rigid_.emplace(this->exec(), scene_, world_, solver::make_plan(scene_, world_));
        rigid_->command(std::vector<solver::BodyCommand>(2));
    }

    void throw_ball(double speed)
    {
        const Vec3<double> velocity(0, speed, 0);
        copy_from_host(this->exec(), rigid_->view().velocity + 1, &velocity, sizeof(velocity));
        rigid_->stage();
    }

    /// Returns how many of the substeps were done.
    std::int64_t run(std::int64_t substeps)
    {
        rigid_->run(step / 10, 0, substeps);
        return rigid_->take_done(step / 10);
    }

    std::int64_t searches() const
    {
        const auto found = this->counters.launches().find("allowed displacements");
        return found == this->counters.launches().end() ? 0 : found->second;
    }

    scene::Scene                           scene_ = test::load_text(balls);
    world::World                           world_ = world::build_world(scene_);
    std::optional<solver::DemSolver<Exec>> rigid_;
};
TYPED_TEST_SUITE(RigidLists, test::Backends, test::BackendNames);

/// The ball moves 0.5 mm in a substep, and lists of bodies at rest allow 0.15: it is seen after the first substep, and
/// the batch ends with the second, as on several ranks (ranks/lists.cpp).
TYPED_TEST(RigidLists, SubstepsEndWithTheLastThatTheListServes)
{
    auto& rigid = *this->rigid_;
    rigid.find_pairs(step);
    ASSERT_EQ(this->searches(), 1);
    this->throw_ball(5);
    const solver::TimeStep ten{step, 10, ""};
    rigid.begin_substeps(ten, 5, 0);
    ASSERT_GE(rigid.until_agreement(), 10) << "nobody to agree with";
    ASSERT_FALSE(rigid.must_agree());
    EXPECT_EQ(this->run(10), 2);
    EXPECT_TRUE(rigid.find_pairs_if_displaced(ten, 2, 0));
    EXPECT_EQ(this->searches(), 2);
    EXPECT_EQ(this->run(8), 8);
    EXPECT_FALSE(rigid.find_pairs_if_displaced(ten, 10, 0));
    EXPECT_EQ(this->searches(), 2);
}

/// A list allows for two steps' motion. If displacements are checked within a step, half a step's motion must remain
/// when it begins: a list serves a second step, but not a third.
TYPED_TEST(RigidLists, ListServesTwoSteps)
{
    auto&            rigid = *this->rigid_;
    constexpr double speed = 0.2 * radius / step; // m/s
    this->throw_ball(speed);
    rigid.find_pairs(step);
    ASSERT_EQ(this->searches(), 1);
    rigid.begin_substeps({step, 10, ""}, speed, 0); // the substeps look ahead
    this->run(10);
    rigid.find_pairs(step);
    EXPECT_EQ(this->searches(), 1);
    this->run(10);
    rigid.find_pairs(step);
    EXPECT_EQ(this->searches(), 2);
}

} // namespace
