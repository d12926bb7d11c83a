#pragma once

#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "energy_balance.hpp"

// A body without weight that turns about an axis along y.
namespace tread::test
{

constexpr double turning_middle = 0.8; ///< m, of the axis along y of the rotation

/// An elastic body without weight, one cell thick; `shape`: lines of its terrain. `numerics`: lines of that table.
inline std::string turning_text(const std::string& shape, const std::string& numerics, double dt, double duration)
{
    return fmt::format(R"(
title = "turning body"
[domain]
size    = [1.6, 0.05, 1.6]
gravity = [0.0, 0.0, 0.0]
walls   = {{ x = "open", y = "slip", bottom = "open", top = "open" }}
[grid]
spacing = 0.05
[time]
dt = {}
[numerics]
precision = "double"
{}
[[material]]
name    = "soft"
model   = "elastic"
density = 1000.0
young   = 1.0e6
poisson = 0.3
[[terrain]]
material = "soft"
{}
[[phase]]
name     = "turn"
duration = {}
)",
                       dt, numerics, shape, duration);
}

/// Starts the body's rotation at `rate` (1/s), without stress, and its ledger.
template<class Exec>
void set_turning(Experiment<Exec>& run, double rate)
{
    auto&             points = run.simulation().sand().points();
    const auto        x      = points.position.to_host();
    auto              v      = points.velocity.to_host();
    const std::size_t n      = x.size() / 3;
    for (std::size_t i = 0; i < n; ++i)
    {
        v[i]         = rate * (x[2 * n + i] - turning_middle);
        v[2 * n + i] = -rate * (x[i] - turning_middle);
    }
    points.velocity.assign(v);
    points.stress.fill_zero();
    run.simulation().ledger() = solver::Ledger({0, 0, 0}, run.simulation().census());
}

} // namespace tread::test
