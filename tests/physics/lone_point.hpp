#pragma once

#include <fmt/format.h>

#include "harness.hpp"

// A single sand point far from the origin.
namespace tread::test
{

/// Scene of one point at `x` m in a domain a kilometre long; `numerics`: lines of that table; `dt` and `duration` in s.
inline std::string lone_point(double x, double gravity, const std::string& numerics, const std::string& dt,
                              double duration)
{
    return fmt::format(R"(
title = "lone point"
[domain]
size    = [1000.0, 1.0, 8.0]
gravity = [0.0, 0.0, {}]
[grid]
spacing = 0.05
[time]
dt = {}
[numerics]
{}
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 30.0
[[terrain]]
material = "sand"
region = {{ box = [[{}, 0.5, 2.0], [{}, 0.525, 2.025]] }}
[[phase]]
name = "fly"
duration = {}
)",
                       gravity, dt, numerics, x, x + 0.025, duration);
}

/// Sets the point's velocity (m/s) and zero stress.
template<class Exec, class Real>
void throw_it(Experiment<Exec, Real>& run, const Vec3<double>& velocity)
{
    auto& points = run.simulation().sand().points();
    ASSERT_EQ(points.count, 1);
    points.velocity.assign(
        {static_cast<Real>(velocity[0]), static_cast<Real>(velocity[1]), static_cast<Real>(velocity[2])});
    points.stress.fill_zero();
}

/// Moves at 1 mm/s in steps of 10 us at x = 900 m: 1e-8 m a step, which a single-precision position would lose
/// entirely.
template<class Real, class Exec>
void creep(const Exec& exec, const std::string& precision, int steps)
{
    const double           duration = steps * 1e-5;
    Experiment<Exec, Real> run(exec, lone_point(900, 0, "precision = \"" + precision + "\"", "1.0e-5", duration));
    throw_it(run, {1e-3, 0, 0});
    const double start = run.simulation().sand().positions()[0][0];
    run.run();
    const double moved = run.simulation().sand().positions()[0][0] - start, expected = 1e-3 * duration;
    report("creep over the exact way, " + precision, moved / expected, 1, 1e-3, "0.1 %");
    EXPECT_NEAR(moved, expected, 1e-3 * expected);
}

} // namespace tread::test
