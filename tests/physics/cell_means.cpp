#include <cmath>
#include <random>

#include "harness.hpp"

namespace
{

using namespace tread;

template<class Exec>
class CellMeans : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(CellMeans, test::Backends, test::BackendNames);

/// A block whose points have arbitrary velocities and stresses, as in dilating flow of sand: the power of the nodal
/// forces equals the power stored by the laws. Cell-averaged strains are the adjoint of nodal forces from cell-averaged
/// pressure, and of no others.
TYPED_TEST(CellMeans, ForcesDoTheWorkThatTheLawsSee)
{
    const std::string           text = R"(
title = "any velocity, any stress"
[domain]
size    = [0.6, 0.6, 0.6]
gravity = [0.0, 0.0, 0.0]
[grid]
spacing = 0.05
[numerics]
precision     = "double"
volume_strain = "cell-average"
[[material]]
name    = "block"
model   = "elastic"
density = 1000.0
young   = 1.0e6
[[terrain]]
material = "block"
region   = { box = [[0.2, 0.2, 0.2], [0.4, 0.4, 0.4]] }
[[phase]]
name     = "step"
duration = 1.0
)";
    test::Experiment<TypeParam> block(this->exec(), text);
    auto&                       sand = block.simulation().sand();
    std::mt19937_64             random(7);
    const auto                  scramble = [&](auto& array, double middle, double reach)
    {
        std::uniform_real_distribution<double> any(middle - reach, middle + reach);
        auto                                   values = array.to_host();
        for (auto& value : values) { value = any(random); }
        array.assign(values);
    };
    scramble(sand.points().velocity, 0.0, 1.0);
    scramble(sand.points().stress, 0.0, 1.0e3);
    scramble(sand.points().volume_ratio, 1.0, 0.1);
    constexpr double dt = 1e-12; // s: forces are constant during it
    sand.order();
    sand.scatter();
    sand.update_grid(dt, 0);
    sand.gather(dt);
    const solver::SandReport report = sand.report();
    const double power = report.grid[mpm::grid_power_before], stored = report.points[mpm::point_stress_power];
    // In the step the stress grows by E grad v dt: V E (grad v)^2 dt W, with grad v up to a velocity of 1 m/s over a
    // spacing.
    const double tolerance = 8e-3 * 1e6 * 20 * 20 * dt;
    test::report("power of the forces in W", power, -stored, tolerance, "what the step adds to the stress");
    EXPECT_NEAR(power, -stored, tolerance);
    EXPECT_GT(std::abs(stored), 1e4 * tolerance);
}

} // namespace
