#include <cmath>

#include <fmt/format.h>

#include "energy_balance.hpp"

// Sand on a grid with finer cells in boxes: results that refinement must not change.
namespace refined_grid_test
{

using namespace tread;

template<class Exec>
class RefinedGrid : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(RefinedGrid, test::Backends, test::BackendNames);

template<class Exec>
class FullSizeRefinedGrid : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FullSizeRefinedGrid, test::Backends, test::BackendNames);

/// A block falls through a box with two levels: its points pass from coarse cells into fine and finest ones and back.
TYPED_TEST(RefinedGrid, BlockInFreeFlightIsAStone)
{
    const std::string           text = R"(
title = "block in free flight"
[domain]
size    = [1.0, 1.0, 2.0]
gravity = [0.3, 0.0, -9.81]
walls   = { top = "open" }
[grid]
spacing = 0.05
refine  = [[[0.25, 0.25, 0.8], [0.75, 0.75, 1.55]], [[0.4, 0.4, 1.0], [0.6, 0.6, 1.4]]]
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 30.0
cohesion = 100.0
[[terrain]]
material = "sand"
region = { box = [[0.4, 0.4, 1.5], [0.6, 0.6, 1.7]] }
velocity = [0.2, -0.1, -2.0]
[[phase]]
name = "fall"
duration = 0.3
[numerics]
precision = "double"
)";
    test::Experiment<TypeParam> fall(this->exec(), text);
    fall.simulation().sand().points().stress.fill_zero(); // it starts in the air, not in a bed
    const solver::Census start = fall.simulation().census();
    fall.run();
    const solver::Census end  = fall.simulation().census();
    const double         mass = start.sand.mass, t = fall.time();
    test::report("mass in kg", mass, 1600 * 0.008, 1e-9, "the lattices of the levels fill the block");
    EXPECT_NEAR(mass, 1600 * 0.008, 1e-9);
    const double drop = (start.sand.moment[2] - end.sand.moment[2]) / mass, expected = (2 + 0.5 * 9.81 * t) * t;
    const double tolerance = 9.81 * t * fall.dt();
    test::report("drop in m", drop, expected, tolerance, "symplectic Euler: g t dt");
    EXPECT_NEAR(drop, expected, tolerance);
    // As on a grid of one level: 5 m/s x 1e-14 / h x t.
    const double strain = 5 * 1e-14 / 0.0125 * t, rounding = 1.346e6 * strain * strain * mass / 1600;
    test::report("strain energy in J", end.sand.strain, 0, rounding, "uniform velocity: rounding of the weights");
    EXPECT_LT(end.sand.strain, rounding);
    EXPECT_NEAR(end.sand.momentum[2], -mass * (2 + 9.81 * t), 1e-9 * mass * 9.81 * t);
}

/// `refine`: a line of [grid], or nothing.
std::string bed(const std::string& refine)
{
    return fmt::format(R"(
title = "a ball on a bed"
[domain]
size    = [0.8, 0.8, 0.7]
gravity = [0.0, 0.0, -9.81]
walls   = {{ x = "slip", y = "slip", bottom = "fixed", top = "open" }}
[grid]
spacing = 0.04
{}
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 35.0
[[terrain]]
material = "sand"
region = {{ box = [[0.0, 0.0, 0.0], [0.8, 0.8, 0.32]] }}
[numerics]
precision = "double"
)",
                       refine);
}

const std::string ball = R"(
[[material]]
name = "steel"
model = "rigid"
young = 7.0e10
density = 2700.0
[[contact]]
between = ["steel", "sand"]
friction = 0.5
[[shape]]
name = "ball"
generate = { kind = "sphere" }
[[body]]
name = "ball"
shape = "ball"
material = "steel"
density = 2700.0
diameter = 0.16
position = [0.41, 0.39, 0.42]
velocity = [0.6, 0.0, -1.5]
[[phase]]
name = "fall"
duration = 0.08
)";

const std::string boxes = "refine = [[[0.2, 0.2, 0.18], [0.62, 0.6, 0.6]]]";

/// Only the seams could disturb a bed at rest: the splines of both levels represent linear stress.
TYPED_TEST(FullSizeRefinedGrid, BedStaysAtRest)
{
    const std::string           rest = "[[phase]]\nname = \"rest\"\nduration = 0.3\n";
    test::Experiment<TypeParam> run(this->exec(), bed(boxes) + rest);
    const solver::Census        start = run.simulation().census();
    double                      most  = 0;
    run.run([&](double) { most = std::max(most, run.simulation().pace().largest_speed); });
    const solver::Census end = run.simulation().census();
    const double         sag = (start.sand.moment[2] - end.sand.moment[2]) / start.sand.mass;
    // Pressure steps between points of two sizes: a tenth of the weight of a coarse cell, on a modulus of 1.35 MPa.
    const double tolerance = 0.1 * 1600 * 9.81 * 0.04 / 1.35e6 * 0.32;
    test::report("sag of the mean height in m", sag, 0, tolerance, "a tenth of a coarse cell's weight in strain");
    EXPECT_LT(std::abs(sag), tolerance);
    test::report("largest speed in m/s", most, 0, 0.01, "what sleeps is never faster: docs/sleep.md");
    EXPECT_LT(most, 0.01);
}

/// The ball lands in the box and throws sand across its borders: momentum is conserved to rounding, energy accounted
/// for.
TYPED_TEST(FullSizeRefinedGrid, EnergyBalanceOfABallClosesAcrossSeams)
{
    test::Experiment<TypeParam> run(this->exec(), bed(boxes) + ball);
    const double                unaccounted = test::largest_unaccounted(run);
    const double                error = run.simulation().ledger().balance(run.simulation().census()).impulse_error;
    test::report("impulse error over weight x time", error, 0, 1e-10, "fp64 rounding");
    EXPECT_LT(error, 1e-10);
    test::report("unaccounted over the largest energy", unaccounted, 0, test::closes, "as on a grid of one level");
    EXPECT_LT(unaccounted, test::closes);
}

/// A box around the contact is as good as fine cells everywhere: the ball reaches the same depth, to 15 % of the
/// difference from the coarse grid.
TYPED_TEST(FullSizeRefinedGrid, BallGoesAsDeepAsOnFineCellsEverywhere)
{
    const auto depth = [&](const std::string& refine, double spacing)
    {
        scene::Scene scene = test::load_text(bed(refine) + ball);
        scene.grid.spacing = spacing;
        test::Experiment<TypeParam> run(this->exec(), scene);
        double                      lowest = 1;
        run.run([&](double) { lowest = std::min(lowest, run.simulation().place(0)[2]); });
        return 0.32 + 0.08 - lowest;
    };
    const double coarse = depth("", 0.04), fine = depth("", 0.02), refined = depth(boxes, 0.04);
    const double tolerance = 0.15 * std::abs(fine - coarse);
    test::report("depth in m", refined, fine, tolerance,
                 fmt::format("a sixth of what halving all cells changes: {}", coarse));
    EXPECT_NEAR(refined, fine, tolerance);
}

} // namespace refined_grid_test
