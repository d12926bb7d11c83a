#include <fmt/format.h>

#include "rank_run.hpp"
#include "solver/bodies/dem_solver.hpp"

// Lifetime of a list of pairs on several ranks, which agree on what bodies find as they look ahead; on one rank:
// unit/solver/rigid_lists.cpp.
namespace tread
{
namespace
{

constexpr double step = 1e-3; // s

/// Two balls, out of each other's reach.
std::string balls()
{
    const auto ball = [](const char* name, double x)
    {
        return fmt::format(R"(
[[body]]
name     = "{}"
shape    = "ball"
material = "steel"
diameter = 0.1
density  = 7800.0
position = [{}, 0.5, 0.5]
)",
                           name, x);
    };
    return test::steel_text + R"(
[time]
dt       = 1.0e-3
substeps = 10
)" + ball("still", 1) +
           ball("thrown", 2) + R"(
[[phase]]
name     = "go"
duration = 0.01
)";
}

template<class Exec>
class ListsOfRanks : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(ListsOfRanks, test::Backends, test::BackendNames);

/// The ball moves 0.5 mm in a substep, and lists of bodies at rest allow 0.15: the rank that owns it sees so after the
/// first substep, and all ranks end with the second.
TYPED_TEST(ListsOfRanks, AllEndWithTheLastSubstepThatTheListServes)
{
    const scene::Scene               scene = test::load_text(balls());
    world::World                     world = world::build_world(scene);
    decomp::Decomposition<TypeParam> decomposition(test::world(), this->exec(), test::decomposition_options());
    solver::share_out(decomposition, world);
    solver::DemSolver<TypeParam> rigid(this->exec(), scene, world,
                                       solver::make_plan(scene, world, test::world().size()), &decomposition);
    rigid.command(std::vector<solver::BodyCommand>(2));
    rigid.find_pairs(step);
    const Vec3<double> velocity(0, 5, 0);
    copy_from_host(this->exec(), rigid.view().velocity + 1, &velocity, sizeof(velocity));
    rigid.stage();
    const solver::TimeStep ten{step, 10, ""};
    rigid.begin_substeps(ten, 5, 0);
    ASSERT_EQ(rigid.until_agreement(), 1);
    const auto run = [&](int substeps)
    {
        for (int substep = 0; substep < substeps; ++substep)
        {
            rigid.run(step / 10, 0, 1);
            if (rigid.must_agree()) { rigid.agree_on_list(); }
        }
        return rigid.take_done(step / 10);
    };
    EXPECT_EQ(run(10), 2);
    EXPECT_TRUE(rigid.find_pairs_if_displaced(ten, 2, 0));
    EXPECT_EQ(run(8), 8) << "the new list knows its speed";
    EXPECT_FALSE(rigid.find_pairs_if_displaced(ten, 10, 0));
}

} // namespace
} // namespace tread
