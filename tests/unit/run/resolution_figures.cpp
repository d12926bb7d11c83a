#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "run/resolution_figures.hpp"
#include "scene_text.hpp"
#include "solver/pace_limits.hpp"

// Worst values of a run's resolution figures, and the resulting verdict.
namespace
{

using namespace tread;
using namespace tread::run;

struct Rolled
{
    explicit Rolled(const std::string& text)
        : scene(test::load_text(text))
        , world(world::build_world(scene))
        , plan(solver::make_plan(scene, world))
        , limits(solver::pace_limits(scene, world, plan))
    {
    }

    std::optional<io::Figure> figure(const std::string& name, const io::ErrorReport& errors = {}) const
    {
        for (const io::Figure& one : figures(extremes, errors, limits, world, plan, driven_wheel(scene, world, plan)))
        {
            if (one.name == name) { return one; }
        }
        return std::nullopt;
    }

    scene::Scene       scene;
    world::World       world;
    solver::Plan       plan;
    solver::PaceLimits limits;
    solver::Extremes   extremes;
};

contact::Summary touching(std::int64_t points, double overlap)
{
    contact::Summary summary = contact::Summary::zero();
    summary.live = summary.live_named = points;
    summary.deepest.value             = overlap;
    return summary;
}

TEST(Extremes, KeepTheWorstStep)
{
    Rolled       run(test::roller_text);
    const double automatic = run.limits.courant * run.limits.spacing / run.limits.wave_speed;
    solver::Pace pace;
    pace.stiffest_point = 0.5 / (automatic * automatic);
    run.extremes.note({automatic, 1, ""}, 1, run.limits, pace, touching(16, 0.2));
    EXPECT_NEAR(run.figure("margin_wave")->value, 1, 1e-12);
    EXPECT_NEAR(run.figure("margin_sand_contact")->value, 1, 1e-12);
    EXPECT_EQ(run.figure("margin_wave")->verdict(), io::Verdict::resolved);

    run.extremes.note({2 * automatic, 1, ""}, 1, run.limits, pace, touching(16, 0.1));
    EXPECT_NEAR(run.figure("margin_wave")->value, 0.5, 1e-12);
    EXPECT_NEAR(run.figure("margin_sand_contact")->value, 0.5, 1e-12);
    EXPECT_EQ(run.figure("margin_wave")->verdict(), io::Verdict::under_resolved);
    EXPECT_EQ(run.figure("point_overlap")->value, 0.2);
}

/// Patch as a square, averaged over the time in contact only: 16 points for one step, 64 for three, none for a hundred.
TEST(Extremes, MeasureTheContactPatch)
{
    Rolled run(test::roller_text);
    run.extremes.note({1e-3, 1, ""}, 1, run.limits, {}, touching(16, 0));
    run.extremes.note({1e-3, 1, ""}, 3, run.limits, {}, touching(64, 0));
    run.extremes.note({1e-3, 1, ""}, 100, run.limits, {}, touching(0, 0));
    EXPECT_NEAR(points_across(run.extremes, run.world), std::sqrt((16 + 3 * 64) / 4.0), 1e-12);
    // With 8 points per cell, two are across it.
    EXPECT_NEAR(run.figure("contact_cells")->value, 0.5 * std::sqrt(52.0), 1e-12);
}

/// A patch as wide as the domain is a strip: its length counts, not the side of a square of the same area.
TEST(Extremes, MeasureTheContactPatchOfASlab)
{
    Rolled       run(test::roller_text);
    const double spacing = run.world.geometry.spacing;
    EXPECT_NEAR(world::patch_side(9 * spacing * spacing, run.world), 3 * spacing, 1e-12);
    run.world.geometry.size[1] = 2 * spacing;
    EXPECT_NEAR(world::patch_side(26 * spacing * spacing, run.world), 13 * spacing, 1e-12);
    EXPECT_EQ(world::patch_side(0, run.world), 0);
    // With 8 points per cell, two are across it: a strip of 2 x 13 cells.
    run.extremes.note({1e-3, 1, ""}, 1, run.limits, {}, touching(4 * 26, 0));
    EXPECT_NEAR(run.figure("contact_cells")->value, 13, 1e-12);
}

TEST(Extremes, SayNothingOfWhatTheSceneHasNot)
{
    const Rolled sand(test::sand_text);
    for (const char* name : {"margin_sand_contact", "contact_cells", "body_overlap", "margin_body_contact"})
    {
        EXPECT_FALSE(sand.figure(name).has_value()) << name;
    }
    EXPECT_TRUE(sand.figure("transfer_loss").has_value());
}

TEST(Extremes, CountEnergyThatWasMadeLikeEnergyThatWasLost)
{
    const Rolled run(test::sand_text);
    EXPECT_EQ(run.figure("energy_error", {0, 0, -0.2})->verdict(), io::Verdict::under_resolved);
    EXPECT_EQ(run.figure("energy_error", {0, 0, std::nan("")})->verdict(), io::Verdict::under_resolved);
    EXPECT_EQ(run.figure("energy_error", {0, 0, 0.02})->verdict(), io::Verdict::marginal);
}

} // namespace
