#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness.hpp"

// Head-on collision of a rigid sphere with an elastic one of points (the paper's 3.1,
// docs/verification.md#head-on-collision).
namespace tread::test
{

struct HeadOn
{
    double duration = 0; ///< s, from the first to the last force
    double force    = 0; ///< N, the largest
    double body     = 0; ///< m/s, along x at the end
    double points   = 0; ///< m/s, of their centre of mass at the end
    double energy   = 0; ///< largest change of the total stored energy, over the energy at the start
    double momentum = 0; ///< largest change, over the momentum of one sphere
};

/// Runs a scene of configs/paper; `overrides` as on the command line.
template<class Exec, class Real>
HeadOn collide(const Exec& exec, const std::string& scene, std::vector<std::string> overrides)
{
    overrides.emplace_back("output.snapshots_every=0");
    Experiment<Exec, Real> run(exec, scene::load_scene(scene, overrides));
    auto&                  simulation = run.simulation();
    const double           body_mass = run.world().bodies.mass.at(0), point_mass = simulation.census().sand.mass;
    const double           start = 0.5 * (body_mass + point_mass), momentum = body_mass - point_mass; // both at 1 m/s
    HeadOn                 found;
    double                 first = -1, last = 0;
    simulation.begin_mean();
    run.run(
        [&](double time)
        {
            const auto ball = simulation.named_bodies().at(0);
            simulation.begin_mean();
            const double force = -ball.force[0];
            found.force        = std::max(found.force, force);
            if (force > 0)
            {
                first = first < 0 ? time - run.dt() : first;
                last  = time;
            }
            const solver::Census    now    = simulation.census();
            const solver::EnergyRow energy = simulation.ledger().energy(now);
            const double            stores =
                energy.kinetic_points + energy.half_step + energy.strain + energy.kinetic_bodies + energy.contact;
            found.energy   = std::max(found.energy, std::abs(stores / start - 1));
            const double p = now.sand.momentum[0] + now.rigid.momentum[0];
            found.momentum = std::max(found.momentum, std::abs(p - momentum) / body_mass);
            found.body     = ball.velocity[0];
            found.points   = now.sand.momentum[0] / point_mass;
        });
    found.duration = last - first;
    return found;
}

/// Checks the bands of docs/verification.md#head-on-collision; the limit is Hertz's law for a rigid and an elastic
/// sphere (24.61 ms, 10.02 kN).
inline void expect_catalogue(const HeadOn& found, const std::string& with, double rounding)
{
    report("duration in ms" + with, found.duration * 1e3, 24.5, 1, "docs/verification.md#head-on-collision");
    report("largest force in kN" + with, found.force / 1e3, 10.15, 0.65, "docs/verification.md#head-on-collision");
    report("final speed of the body" + with, -found.body, 0.98, 0.02, "docs/verification.md#head-on-collision");
    report("final speed of the points" + with, found.points, 0.98, 0.02, "docs/verification.md#head-on-collision");
    report("energy" + with, found.energy, 0, 0.05, "docs/verification.md#head-on-collision");
    report("momentum" + with, found.momentum, 0, rounding, "rounding of every step");
    EXPECT_NEAR(found.duration, 24.5e-3, 1e-3);
    EXPECT_NEAR(found.force, 10.15e3, 0.65e3);
    EXPECT_NEAR(-found.body, 0.98, 0.02);
    EXPECT_NEAR(found.points, 0.98, 0.02);
    EXPECT_LT(found.energy, 0.05);
    EXPECT_LT(found.momentum, rounding);
}

} // namespace tread::test
