#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "harness.hpp"

// Columns one cell wide between slip walls: hydrostatic stress above the floor, and local damping.
namespace columns_test
{

using namespace tread;

template<class Exec>
class Columns : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Columns, test::Backends, test::BackendNames);

constexpr double gravity = 9.81, density = 1800, height = 0.1, young = 1e6;
constexpr double base_stress = density * gravity * height;

/// docs/verification.md#geostatic-column: 0.1 m high; x and y one cell wide.
std::string column_text(double spacing, const std::string& law, const std::string& walls)
{
    return fmt::format(R"(
title = "column"
[domain]
size    = [{0}, {0}, {1}]
gravity = [0.0, 0.0, -{2}]
walls   = {{ x = "slip", y = "slip", {3} }}
[grid]
spacing = {0}
[numerics]
precision = "double"
[[material]]
name    = "sand"
density = {4}
young   = {5}
{6}
[[terrain]]
material = "sand"
region = {{ box = [[0.0, 0.0, 0.0], [{0}, {0}, {7}]] }}
[[phase]]
name = "rest"
damping = 0.7
duration = 0.15
)",
                       spacing, height + 4 * spacing, gravity, walls, density, young, law, height);
}

struct Column
{
    std::vector<double> depth;      ///< m, of the points at the start
    std::vector<double> vertical;   ///< Pa, at the end, pressure
    std::vector<double> horizontal; ///< Pa
    double              reaction;   ///< N, of the floor
    double              weight;     ///< N
};

/// Starts with `share` of the stress at rest, so that the remaining load is applied during the run.
template<class Exec>
Column settle(const Exec& exec, const std::string& text, double share)
{
    test::Experiment<Exec> experiment(exec, text);
    auto&                  sand   = experiment.simulation().sand();
    auto                   stress = sand.points().stress.to_host();
    for (double& component : stress) { component *= share; }
    sand.points().stress.assign(stress);
    experiment.run();
    const auto start  = sand.points().start.to_host();
    const auto end    = sand.points().stress.to_host();
    const auto stride = static_cast<std::size_t>(sand.points().stride);
    const auto count  = static_cast<std::size_t>(sand.count());
    Column     column;
    for (std::size_t i = 0; i < count; ++i)
    {
        column.depth.push_back(height - start[2 * stride + i]);
        column.horizontal.push_back(-end[i]);
        column.vertical.push_back(-end[2 * stride + i]);
    }
    sand.report();
    sand.order();
    sand.scatter();
    sand.update_grid(experiment.dt(), 0);
    column.reaction = sand.report().grid[mpm::grid_wall_impulse + 2] / experiment.dt();
    column.weight   = sand.census().mass * gravity;
    return column;
}

/// Largest error of the vertical stress, over the stress at the base, of points in a range of depths.
double worst(const Column& column, double from, double to)
{
    double error = 0;
    for (std::size_t i = 0; i < column.depth.size(); ++i)
    {
        if (column.depth[i] < from || column.depth[i] > to) { continue; }
        error = std::max(error, std::abs(column.vertical[i] - density * gravity * column.depth[i]) / base_stress);
    }
    return error;
}

const std::string elastic = "model = \"elastic\"\npoisson = 0.0";

/// The column starts without stress, on either floor, and becomes hydrostatic, also beside the floor. Between the wall
/// and half a cell a spline that vanishes with its mirror image is a straight line: the stress there is that at half a
/// cell's height, and off by up to a quarter of a cell's weight at the points. So the stress converges with first order
/// there.
TYPED_TEST(Columns, HydrostaticOnSlipAndFixedFloors)
{
    for (const std::string floor : {"slip", "fixed"})
    {
        double errors[2] = {};
        for (int level = 0; level < 2; ++level)
        {
            const double      spacing = level == 0 ? 0.01 : 0.005, quarter = 0.25 * spacing / height;
            const std::string walls   = "bottom = \"" + floor + "\", top = \"open\"";
            const Column      column  = settle(this->exec(), column_text(spacing, elastic, walls), 0);
            const double      beside  = worst(column, height - spacing, height);
            const double      inner   = worst(column, 2 * spacing, height - 2 * spacing);
            const double      surface = worst(column, 0, 2 * spacing);
            const std::string at      = fmt::format(" ({} floor, {} cells)", floor, std::lround(height / spacing));
            errors[level]             = std::max(beside, inner);
            test::report("stress beside the floor, error over base" + at, beside, 0, quarter,
                         "a quarter cell's weight");
            test::report("stress in the middle, error over base" + at, inner, 0, 0.01,
                         "docs/verification.md#geostatic-column: 1 % of the base");
            test::report("stress under the surface, error over base" + at, surface, 0, 2 * quarter,
                         "half a cell's weight");
            test::report("floor reaction over weight" + at, column.reaction / column.weight, 1, 1e-3, "at rest");
            EXPECT_LT(beside, quarter);
            EXPECT_LT(inner, 0.01);
            EXPECT_LT(surface, 2 * quarter);
            EXPECT_NEAR(column.reaction / column.weight, 1, 1e-3);
        }
        const double order = std::log2(errors[0] / errors[1]);
        test::report("order of convergence (" + floor + " floor)", order, 1, 0.1, "first order beside the floor");
        EXPECT_GT(order, 0.9);
    }
}

/// Linear splines have one stress per cell, that of its middle: off by a quarter of a cell's weight at the points.
/// There is no node beyond the wall, and none is needed.
TYPED_TEST(Columns, HydrostaticWithLinearSplines)
{
    for (const std::string floor : {"slip", "fixed"})
    {
        const double spacing = 0.005, most = 0.25 * spacing / height + base_stress / young;
        std::string  text = column_text(spacing, elastic, "bottom = \"" + floor + "\", top = \"open\"");
        text.insert(text.find("precision"), "shape_functions = \"linear\"\n");
        const Column column = settle(this->exec(), text, 0);
        const double error  = worst(column, 2 * spacing, height);
        test::report("stress, error over base (linear, " + floor + " floor)", error, 0, most,
                     "a quarter cell's weight");
        test::report("floor reaction over weight", column.reaction / column.weight, 1, 1e-3, "at rest");
        EXPECT_LT(error, most);
        EXPECT_NEAR(column.reaction / column.weight, 1, 1e-3);
    }
}

/// docs/verification.md#geostatic-column: K = nu / (1 - nu) if that exceeds Ka; otherwise sand yields, and K = Ka. The
/// last twentieth of the load is applied during the run; the overshoot, sqrt((1 - 0.7) / (1 + 0.7)) of it, is unloaded
/// elastically, so that a plastic K retains (1 - K0 / Ka) of it: 0.5 %.
TYPED_TEST(Columns, GeostaticElasticAndPlastic)
{
    const double active = 1.0 / 3.0; // 30 degrees
    for (const double poisson : {0.3, 0.2})
    {
        const double expected = std::max(poisson / (1 - poisson), active);
        for (const double spacing : {0.01, 0.005})
        {
            const std::string law =
                fmt::format("model = \"mohr-coulomb\"\npoisson = {}\nfriction_angle_deg = 30.0\n", poisson);
            const Column column =
                settle(this->exec(), column_text(spacing, law, "bottom = \"fixed\", top = \"open\""), 0.95);
            double ratio_error = 0, own_line = 0;
            for (std::size_t i = 0; i < column.depth.size(); ++i)
            {
                if (column.depth[i] < 2 * spacing || column.depth[i] > height - 2 * spacing) { continue; }
                ratio_error = std::max(ratio_error, std::abs(column.horizontal[i] / column.vertical[i] / expected - 1));
                own_line = std::max(own_line, std::abs(column.vertical[i] / (density * gravity * column.depth[i]) - 1));
            }
            const std::string at    = fmt::format(" (nu {}, {} cells)", poisson, std::lround(height / spacing));
            const double      inner = worst(column, 2 * spacing, height - 2 * spacing);
            test::report("vertical stress, error over base" + at, inner, 0, 0.01,
                         "docs/verification.md#geostatic-column: 1 % of the base");
            test::report("K, relative error" + at, ratio_error, 0, 0.01,
                         "docs/verification.md#geostatic-column: 1 %; 0.5 % of it from the overshoot");
            test::report("stress from point to point" + at, own_line, 0, 0.02,
                         "docs/verification.md#geostatic-column: checkerboard under 2 %");
            test::report("floor reaction over weight" + at, column.reaction / column.weight, 1, 1e-3, "at rest");
            EXPECT_LT(inner, 0.01);
            EXPECT_LT(ratio_error, 0.01);
            EXPECT_LT(own_line, 0.02);
            EXPECT_NEAR(column.reaction / column.weight, 1, 1e-3);
        }
    }
}

std::string bar_text(double damping)
{
    return fmt::format(R"(
title = "bar"
[domain]
size    = [1.5, 0.05, 0.05]
gravity = [0.0, 0.0, 0.0]
walls   = {{ x = "fixed", y = "slip", bottom = "slip", top = "slip" }}
[grid]
spacing = 0.05
[time]
dt = 5e-5
[numerics]
precision = "double"
pic_rate = 0.0
[[material]]
name = "bar"
model = "elastic"
density = 1000.0
young = 1.0e7
poisson = 0.0
[[terrain]]
material = "bar"
region = {{ box = [[0.0, 0.0, 0.0], [1.0, 0.05, 0.05]] }}
[[phase]]
name = "vibrate"
damping = {}
duration = 0.09
)",
                       damping);
}

/// docs/verification.md#local-damping: in its first mode the whole bar oscillates in phase, so that Cundall's law for
/// one mass holds.
TYPED_TEST(Columns, LocalDampingFollowsCundallsLaw)
{
    constexpr double            damping = 0.3;
    test::Experiment<TypeParam> bar(this->exec(), bar_text(damping));
    auto&                       points = bar.simulation().sand().points();
    const auto                  x      = points.position.to_host();
    auto                        v      = points.velocity.to_host();
    for (std::size_t i = 0; i < v.size() / 3; ++i) { v[i] = 0.1 * std::sin(0.5 * std::numbers::pi * x[i]); }
    points.velocity.assign(v);
    std::vector<double> crossings, peaks{bar.simulation().census().sand.momentum[0]};
    double              last = peaks[0], peak = 0;
    bar.run(
        [&](double time)
        {
            const double momentum = bar.simulation().census().sand.momentum[0];
            if (last * momentum < 0)
            {
                crossings.push_back(time - bar.dt() * momentum / (momentum - last));
                if (crossings.size() > 1) { peaks.push_back(peak); }
                peak = 0;
            }
            peak = std::max(peak, std::abs(momentum));
            last = momentum;
        });
    ASSERT_GE(peaks.size(), 4);
    // Between two rests is half a period: half of it with force (1 - alpha), half with (1 + alpha).
    const double half   = (crossings[3] - crossings[0]) / 3;
    const double period = 0.02 * 0.5 * (1 / std::sqrt(1 - damping) + 1 / std::sqrt(1 + damping));
    test::report("half period in s", half, period, 0.01 * period, "C8; the bar's own period is right to 0.2 %");
    EXPECT_NEAR(half, period, 0.01 * period);
    const double ratio = std::cbrt(peaks[3] / peaks[0]), expected = std::sqrt((1 - damping) / (1 + damping));
    test::report("ratio of amplitudes half a period apart", ratio, expected, 0.02 * expected,
                 "C8; 2 %: momentum of the bar, not of one mass");
    EXPECT_NEAR(ratio, expected, 0.02 * expected);
}

/// docs/verification.md#local-damping: a free fall under local damping has the acceleration g (1 - alpha), which is why
/// damping is off in free fall.
TYPED_TEST(Columns, FreeFallUnderLocalDamping)
{
    test::Experiment<TypeParam> fall(this->exec(), R"(
title = "fall under damping"
[domain]
size    = [0.4, 0.4, 2.0]
gravity = [0.0, 0.0, -9.81]
walls   = { x = "open", y = "open", bottom = "open", top = "open" }
[grid]
spacing = 0.05
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 30.0
[[terrain]]
material = "sand"
region = { box = [[0.1, 0.1, 1.5], [0.2, 0.2, 1.6]] }
[[phase]]
name = "fall"
damping = 0.3
duration = 0.2
)");
    fall.simulation().sand().points().stress.fill_zero();
    fall.run();
    const solver::Census end   = fall.simulation().census();
    const double         speed = -end.sand.momentum[2] / end.sand.mass, expected = 0.7 * 9.81 * fall.time();
    const double tolerance = 2 * 9.81 * 0.3 * 1e-3; // the first steps start from rest, where the law has no direction
    test::report("speed in m/s", speed, expected, tolerance,
                 "docs/verification.md#local-damping: g (1 - alpha) t; the first step starts from rest");
    EXPECT_NEAR(speed, expected, tolerance);
    EXPECT_EQ(this->counters.launches().count("update walls"), 0) << "no walls, no launch";
}

} // namespace columns_test
