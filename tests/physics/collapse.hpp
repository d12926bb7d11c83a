#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "harness.hpp"

// Collapse of a sand column, one cell thick, over a rough floor (docs/verification.md#column-collapse).
namespace tread::test
{

struct CollapseSetup
{
    double aspect; ///< height over width of the column
    int    cells;  ///< across the width
};

/// Shape of the deposit, relative to the column's width.
struct Deposit
{
    double run_out;    ///< distance from the column's foot that contains 99 % of the mass: the last grains are isolated
    double front;      ///< distance that contains 99.9 %
    double last_point; ///< distance of the last point
    double height;     ///< of the sand at the wall
};

constexpr double column_width = 0.1; ///< m

/// Walls at x = 0 and y are smooth, as the glass was. No PIC: it acts as a viscosity of some 0.02 c h, too much for a
/// flow as thin as this on grids as coarse as these.
inline std::string collapse_text(const CollapseSetup& setup)
{
    const double spacing = column_width / setup.cells, height = setup.aspect * column_width;
    const double reach = column_width * (1 + 3 * setup.aspect);
    return fmt::format(R"(
title = "column collapse"
[domain]
size    = [{0}, {1}, {2}]
gravity = [0.0, 0.0, -9.81]
walls   = {{ x = "slip", y = "slip", bottom = "fixed", top = "open" }}
[grid]
spacing = {1}
[numerics]
precision = "double"
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 3.0e5
poisson = 0.3
friction_angle_deg = 31.0
[[terrain]]
material = "sand"
region = {{ box = [[0.0, 0.0, 0.0], [{3}, {1}, {4}]] }}
[[phase]]
name = "collapse"
duration = {5}
)",
                       std::ceil(reach / spacing) * spacing, spacing, (std::ceil(height / spacing) + 4) * spacing,
                       column_width, height, 4.5 * std::sqrt(height / 9.81));
}

template<class Exec>
Deposit collapse(const Exec& exec, const CollapseSetup& setup)
{
    Experiment<Exec> experiment(exec, collapse_text(setup));
    experiment.run();
    const double        spacing = column_width / setup.cells;
    std::vector<double> x;
    double              top = 0;
    for (const Vec3<double>& place : experiment.simulation().sand().positions())
    {
        x.push_back(place[0]);
        if (place[0] < spacing) { top = std::max(top, place[2] + 0.25 * spacing); }
    }
    std::sort(x.begin(), x.end());
    return {x[99 * x.size() / 100] / column_width - 1, x[999 * x.size() / 1000] / column_width - 1,
            x.back() / column_width - 1, top / column_width};
}

/// Run-out by Lube et al. (2005), J. Fluid Mech. 541, and Lajeunesse et al. (2005), Phys. Fluids 17: both give 1.2 a
/// for low columns and 1.9 a^(2/3) for high ones; Lube's limits are 1.8 and 2.8.
inline double expected_run_out(double aspect) { return aspect < 1.8 ? 1.2 * aspect : 1.9 * std::pow(aspect, 2.0 / 3); }

/// Height at the wall: Lube a below 1.15, 0.65 a^0.4 above; Lajeunesse a below 0.7, a^(1/3) above. [lowest, highest].
struct HeightRange
{
    double low, high;
};

inline HeightRange expected_height(double aspect)
{
    const double lube       = aspect < 1.15 ? aspect : 0.65 * std::pow(aspect, 0.4);
    const double lajeunesse = aspect < 0.7 ? aspect : std::cbrt(aspect);
    return {std::min(lube, lajeunesse), std::max(lube, lajeunesse)};
}

/// C5: 15 %, the difference between the two groups.
constexpr double collapse_tolerance = 0.15;

inline void check_deposit(const CollapseSetup& setup, const Deposit& left)
{
    const std::string at       = fmt::format(" at aspect {}, {} cells", setup.aspect, setup.cells);
    const double      expected = expected_run_out(setup.aspect);
    report("run-out of 99 % of the mass over the width" + at, left.run_out, expected, collapse_tolerance * expected,
           "docs/verification.md#column-collapse: 15 %, the scatter between two laboratories");
    EXPECT_NEAR(left.run_out, expected, collapse_tolerance * expected);
    const HeightRange height = expected_height(setup.aspect);
    const double      middle = 0.5 * (height.low + height.high);
    report("height at the wall over the width" + at, left.height, middle,
           middle - (1 - collapse_tolerance) * height.low,
           "docs/verification.md#column-collapse: 15 % about what both found");
    EXPECT_GT(left.height, (1 - collapse_tolerance) * height.low);
    EXPECT_LT(left.height, (1 + collapse_tolerance) * height.high);
}

} // namespace tread::test
