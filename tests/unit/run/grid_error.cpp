#include "run/grid_error.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "run/prediction.hpp"
#include "run/resolution_figures.hpp"
#include "scene_text.hpp"
#include "solver/pace_limits.hpp"

// Grid error in the answers of a driven wheel.
namespace
{

using namespace tread;
using namespace tread::run;

const std::string drive_text = R"(
[[phase]]
name     = "drive"
duration = 0.1
drive    = { body = "roller", angular_velocity = 0.7, slip = 0.3 }
)";

/// Coarse distance field and nodes: they are irrelevant here, but take most of the time.
std::vector<std::string> with_coarse_shape(std::vector<std::string> overrides)
{
    overrides.emplace_back("shape.roller.sdf_cells=16");
    overrides.emplace_back("shape.roller.node_spacing=0.05");
    return overrides;
}

/// The roller of 4 kg, driven, with a friction of 0.8 on the sand.
struct Driven
{
    explicit Driven(const std::vector<std::string>& overrides = {}, const std::string& phase = drive_text)
        : scene(test::load_text(test::roller_text + "[[contact]]\nbetween = [\"steel\", \"sand\"]\nfriction = 0.8\n" +
                                    phase,
                                with_coarse_shape(overrides)))
        , world(world::build_world(scene))
        , plan(solver::make_plan(scene, world))
        , wheel(driven_wheel(scene, world, plan))
    {
    }

    scene::Scene               scene;
    world::World               world;
    solver::Plan               plan;
    std::optional<DrivenWheel> wheel;
};

TEST(GridError, LawsHaveTheirOrder)
{
    const ErrorLaw law{11, 2};
    EXPECT_NEAR(law.at(10), 0.11, 1e-12);
    EXPECT_NEAR(law.at(20), 0.11 / 4, 1e-12);
    EXPECT_NEAR(law.at(law.cells_for(0.05)), 0.05, 1e-12);
}

/// At 20 cells across the patch the first-order error of the pull is 11 % of the load: a drum that is "resolved" by its
/// number of cells alone is not.
TEST(GridError, ADrumOfTwentyCellsIsNotResolved)
{
    const Driven run;
    ASSERT_TRUE(run.wheel.has_value());
    EXPECT_NEAR(run.wheel->load, 4 * 9.81, 1e-9);
    const auto error = grid_error(run.wheel, 20);
    ASSERT_TRUE(error.has_value());
    EXPECT_NEAR(error->pull, run.wheel->laws.pull.factor / 20, 1e-12);
    EXPECT_GT(error->pull, resolved_error);
    EXPECT_EQ(io::verdict_of(grid_error_figures(*error)), io::Verdict::marginal);
    EXPECT_FALSE(grid_error(run.wheel, 0).has_value()) << "nothing was touched";
}

TEST(GridError, StandsAmongTheFiguresOfARun)
{
    const Driven             run;
    const solver::PaceLimits limits = solver::pace_limits(run.scene, run.world, run.plan);
    contact::Summary         touch  = contact::Summary::zero();
    touch.live = touch.live_named = 4 * 64;
    solver::Extremes extremes;
    extremes.note({1e-3, 1, ""}, 1, limits, {}, touch);
    const auto figure = [&](const char* name, const std::optional<DrivenWheel>& wheel) -> std::optional<io::Figure>
    {
        for (const io::Figure& one : figures(extremes, {}, limits, run.world, run.plan, wheel))
        {
            if (one.name == name) { return one; }
        }
        return std::nullopt;
    };
    for (const char* name : {"pull_error", "torque_error", "sinkage_error"})
    {
        ASSERT_TRUE(figure(name, run.wheel).has_value()) << name;
        EXPECT_FALSE(figure(name, std::nullopt).has_value()) << name;
    }
    EXPECT_NEAR(figure("pull_error", run.wheel)->value, run.wheel->laws.pull.at(8), 1e-12);
    EXPECT_EQ(figure("pull_error", run.wheel)->resolved, 0.05);
    EXPECT_EQ(figure("pull_error", run.wheel)->marginal, 0.2);
}

TEST(GridError, IsLeftOutWhereNoConvergenceWasMeasured)
{
    EXPECT_FALSE(Driven({}, "").wheel.has_value()) << "no drive";
    EXPECT_FALSE(Driven({"terrain[0].material=steel"}).wheel.has_value()) << "elastic ground";
}

TEST(GridError, FollowsFrictionAndSoil)
{
    EXPECT_EQ(share_of_friction(SoilKind::frictional, 0.1), 0.22);
    EXPECT_NEAR(share_of_friction(SoilKind::frictional, 0.7), 0.87, 1e-12);
    EXPECT_EQ(share_of_friction(SoilKind::cohesive, 2.0), 1.0);
    const Driven sand, smooth({"contact[0].friction=0.4"}),
        clay({"material.sand.friction_angle_deg=0", "material.sand.cohesion=5000"});
    EXPECT_NEAR(smooth.wheel->laws.pull.factor, 0.22 * sand.wheel->laws.pull.factor, 1e-12);
    EXPECT_EQ(smooth.wheel->laws.torque.factor, sand.wheel->laws.torque.factor);
    EXPECT_NEAR(clay.wheel->laws.pull.factor, measured_convergence[2].laws.pull.factor, 1e-12);
}

TEST(GridError, IsReportedWithTheAnswersOrWithout)
{
    const io::GridError error{1000, 0.18, 0.07, 0.2};
    EXPECT_EQ(io::grid_error_line(error, std::nullopt),
              "pull about 180 N (18 % of the load, first order); torque about 7 %; sinkage about 20 %");
    EXPECT_EQ(io::grid_error_line(error, io::DriveMeans{154, 107.8, 0.0363}),
              "pull 154 N, error of the grid about 180 N (18 % of the load, first order); torque 108 N m, error of "
              "the grid about 7.5 N m (7 %); sinkage 0.0363 m, error of the grid about 0.0073 m (20 %)");
}

const std::vector<std::string> with_grousers{"shape.roller.generate.grousers=12",
                                             "shape.roller.generate.grouser_height=0.02",
                                             "shape.roller.generate.grouser_width=0.01"};

TEST(Grousers, AreCountedInCells)
{
    EXPECT_TRUE(grouser_figures(Driven().wheel, 0.01).empty()) << "a smooth roller";
    EXPECT_TRUE(grouser_figures(std::nullopt, 0.01).empty());
    const Driven run(with_grousers);
    const auto   verdict = [&](double spacing) { return io::verdict_of(grouser_figures(run.wheel, spacing)); };
    EXPECT_NEAR(grouser_figures(run.wheel, 0.01)[0].value, 2, 1e-12);
    EXPECT_EQ(verdict(0.02), io::Verdict::under_resolved);
    EXPECT_EQ(verdict(0.01), io::Verdict::marginal);
    EXPECT_EQ(verdict(0.0079), io::Verdict::resolved);
}

/// Between many grousers a cell has no room, however high they are.
TEST(Grousers, NeedCellsBetweenThem)
{
    std::vector<std::string> many = with_grousers;
    many.emplace_back("shape.roller.generate.grousers=24");
    const Driven few(with_grousers), run(many);
    EXPECT_NEAR(few.wheel->grousers->gap + 0.01, 2 * (run.wheel->grousers->gap + 0.01), 1e-12);
    const double gap = run.wheel->grousers->gap;
    EXPECT_EQ(grouser_figures(run.wheel, gap / 3)[1].verdict(), io::Verdict::marginal);
    EXPECT_EQ(grouser_figures(run.wheel, gap / 2.5)[1].verdict(), io::Verdict::under_resolved);
    EXPECT_EQ(grouser_figures(run.wheel, gap / 4)[1].verdict(), io::Verdict::resolved);
}

TEST(Grousers, GrowWithTheBody)
{
    const auto height = [](const char* diameter)
    {
        std::vector<std::string> sized = with_grousers;
        sized.push_back(std::string("body.roller.diameter=") + diameter);
        return Driven(sized).wheel->grousers->height;
    };
    EXPECT_NEAR(height("0.1") / height("0.05"), 2, 1e-9);
}

/// A patch of many cells is not sufficient if the grousers are smaller than a cell.
TEST(Grousers, DecideThePredictionWhereTheyAreCoarser)
{
    Driven             run(with_grousers);
    const world::Patch patch{0.01, 4, 4, true};
    run.world.geometry.spacing = 0.01;
    const Prediction seen      = predict(patch, run.world, run.plan, run.wheel);
    EXPECT_EQ(seen.verdict, io::Verdict::marginal);
    EXPECT_NEAR(seen.next, std::min(0.02 / resolved_grouser, run.wheel->grousers->gap / resolved_gap), 1e-12);
}

/// The spacing named by a prediction has the promised verdict.
TEST(Prediction, NamesTheSpacingOfTheNextVerdict)
{
    Driven             run;
    const world::Patch patch{0.01, 0.4, 0.4, true}; // 8 cells
    for (const io::Verdict better : {io::Verdict::marginal, io::Verdict::resolved})
    {
        const Prediction seen = predict(patch, run.world, run.plan, run.wheel);
        EXPECT_EQ(static_cast<int>(seen.verdict), static_cast<int>(better) + 1);
        EXPECT_LT(seen.next, run.world.geometry.spacing);
        run.world.geometry.spacing = seen.next * (1 - 1e-9);
    }
    EXPECT_EQ(predict(patch, run.world, run.plan, run.wheel).verdict, io::Verdict::resolved);
    EXPECT_NEAR(predict(patch, run.world, run.plan, std::nullopt).points, 0.4 / run.world.point_spacing, 1e-9);
}

} // namespace
