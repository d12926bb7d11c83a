#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "../statistics.hpp"
#include "harness.hpp"
#include "kernels/dem/bodies.hpp"

// A rigid sphere or wheel on a bed: pushed sideways, pulled along, at rest
// (docs/verification.md#points-during-the-substeps, docs/verification.md#sphere-on-an-elastic-bed and
// #body-at-rest-on-sand).
namespace tread::test
{

struct SphereOnBed
{
    std::string law             = "model = \"elastic\""; ///< keys of the bed's [[material]]
    double      young           = 1e6;                   ///< Pa, of the bed
    double      density         = 2650;                  ///< kg/m3
    double      spacing         = 0.01;                  ///< m, h
    int         points_per_cell = 1;
    double      width = 0.24, depth = 0.08;      ///< m, of the bed
    double      bottom    = 0;                   ///< m, height of its lower side
    std::string beneath   = {};                  ///< tables of what supports the bed there
    double      radius    = 0.1;                 ///< m
    std::string form      = "kind = \"sphere\""; ///< of the body; a sphere has radius 0.5 m at scale 1
    double      weight    = 111;                 ///< N
    double      friction  = 0.3;
    double      sideways  = 0; ///< ratio of gravity along x to gravity downwards, for sphere and bed
    int         sdf_cells = 96;
    std::string motion    = "supported";
    int         substeps  = 100;
    std::string dt        = "\"auto\"";
    double      settling  = 0.15; ///< s, settling phase with local damping of the bed
    double      free      = 0.1;  ///< s, without any damping
    double      speed     = 0;    ///< m/s, imposed along x in the second phase; 0 leaves it free
    double      spin      = 0;    ///< rad/s about y, in the second phase
};

inline constexpr double gravity_of_beds = 9.81; ///< m/s2

inline std::string sphere_on_bed_text(const SphereOnBed& bed)
{
    // Points lie half a spacing below the surface, and reach a radius above it; a hundredth of a cell of clearance.
    const double lattice  = bed.spacing / std::cbrt(bed.points_per_cell);
    const double height   = bed.bottom + bed.depth + bed.radius + (0.6204 - 0.5) * lattice + 0.01 * bed.spacing;
    const bool   sphere   = bed.form.find("sphere") != std::string::npos;
    const auto   diameter = sphere ? fmt::format("diameter = {}", 2 * bed.radius) : std::string();
    return fmt::format(R"(
title = "sphere on a bed"
[domain]
size    = [{width}, {width}, {top}]
gravity = [{gravity_x}, 0.0, -{gravity}]
walls   = {{ x = "slip", y = "slip", bottom = "fixed", top = "open" }}
[grid]
spacing = {spacing}
[time]
dt       = {dt}
substeps = {substeps}
[numerics]
precision    = "double"
point_motion = "{motion}"
[[material]]
name    = "bed"
density = {density}
young   = {young}
poisson = 0.3
{law}
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e15
[[contact]]
between  = ["bed", "steel"]
friction = {friction}
[[terrain]]
material        = "bed"
region          = {{ box = [[0.0, 0.0, {bottom}], [{width}, {width}, {surface}]] }}
points_per_cell = {points}
[[shape]]
name      = "ball"
generate  = {{ {form} }}
sdf_cells = {cells}
[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
{diameter}
mass     = {mass}
position = [{middle}, {middle}, {height}]
lock     = ["y", "roll", "pitch", "yaw"]
{beneath}
[[phase]]
name     = "settle"
damping  = 0.7
duration = {settling}
[[phase]]
name     = "watch"
duration = {free}
)",
                       fmt::arg("width", bed.width), fmt::arg("top", bed.bottom + bed.depth + 3 * bed.radius),
                       fmt::arg("gravity_x", bed.sideways * gravity_of_beds), fmt::arg("gravity", gravity_of_beds),
                       fmt::arg("spacing", bed.spacing), fmt::arg("dt", bed.dt), fmt::arg("substeps", bed.substeps),
                       fmt::arg("motion", bed.motion), fmt::arg("density", bed.density), fmt::arg("young", bed.young),
                       fmt::arg("law", bed.law), fmt::arg("friction", bed.friction), fmt::arg("bottom", bed.bottom),
                       fmt::arg("surface", bed.bottom + bed.depth), fmt::arg("beneath", bed.beneath),
                       fmt::arg("points", bed.points_per_cell), fmt::arg("diameter", diameter),
                       fmt::arg("form", bed.form), fmt::arg("cells", bed.sdf_cells),
                       fmt::arg("mass", bed.weight / gravity_of_beds), fmt::arg("middle", 0.5 * bed.width),
                       fmt::arg("height", height), fmt::arg("settling", bed.settling), fmt::arg("free", bed.free));
}

/// Motion and forces of the sphere in the second phase; forces over its weight.
struct Watched
{
    double creep;       ///< m/s, along x: slope of the regression over the phase
    double pull;        ///< mean resistance of the bed, over the phase's second half
    double lift;        ///< likewise, upwards
    double pull_jitter; ///< standard deviation of the steps' forces there
    double jitter;      ///< likewise, upwards
    double height;      ///< m, of the lowest point above the bed's surface, mean of the second half
    double impulse;     ///< error of the momentum balance over weight x time
    double torque;      ///< mean about y over weight x radius there
    double most_torque; ///< largest in a step there
    double spring;      ///< largest k dt^2/m_p of a contact
    double dt;          ///< s
};

/// Stops each degree of freedom of the sphere when its speed begins to fall, which brings it to rest without a force
/// (kinetic damping, Day 1965).
class KineticDamping
{
public:
    std::uint32_t stops(const Vec3<double>& velocity)
    {
        std::uint32_t locked = 0;
        for (int c = 0; c < 3; ++c)
        {
            const double speed = std::abs(velocity[c]);
            if (speed < last_[c]) { locked |= static_cast<std::uint32_t>(dem::lock_x) << c; }
            last_[c] = speed < last_[c] ? 0 : speed;
        }
        return locked;
    }

private:
    Vec3<double> last_ = Vec3<double>::Zero();
};

template<class Exec>
Watched watch_sphere(
    const Exec& exec, const SphereOnBed& bed, const std::function<void(Experiment<Exec>&)>& at_end = [](auto&) {})
{
    Experiment<Exec>    run(exec, sphere_on_bed_text(bed));
    auto&               simulation = run.simulation();
    KineticDamping      damping;
    std::vector<double> times, places, pulls, lifts, heights, torques;
    double              spring = 0;
    simulation.begin_mean();
    run.steer(
        [&](std::vector<solver::BodyCommand>& commands)
        {
            if (run.time() < bed.settling - 1e-9)
            {
                commands[0].locked |= damping.stops(simulation.named_bodies().at(0).velocity);
            }
            else
            {
                if (bed.speed > 0)
                {
                    commands[0].locked |= dem::lock_x;
                    commands[0].forward = bed.speed;
                }
                if (bed.spin > 0) { commands[0].spin = bed.spin; }
            }
        });
    run.run(
        [&](double time)
        {
            if (time <= bed.settling + 1e-9)
            {
                simulation.begin_mean();
                return;
            }
            const solver::BodyRow ball = simulation.named_bodies().at(0);
            simulation.begin_mean();
            times.push_back(time);
            places.push_back(ball.position[0]);
            heights.push_back(ball.position[2] - bed.radius - bed.depth - bed.bottom);
            pulls.push_back(-ball.force[0] / bed.weight);
            lifts.push_back(ball.force[2] / bed.weight);
            torques.push_back(ball.torque[1] / (bed.weight * bed.radius));
            spring = std::max(spring, simulation.pace().stiffest_point * run.dt() * run.dt());
        });
    at_end(run);
    const std::size_t half = times.size() / 2;
    double            most = 0;
    for (std::size_t i = half; i < torques.size(); ++i) { most = std::max(most, std::abs(torques[i])); }
    return {slope_of(times, places),
            mean_of(pulls, half),
            mean_of(lifts, half),
            deviation_of(pulls, half),
            deviation_of(lifts, half),
            mean_of(heights, half),
            simulation.ledger().balance(simulation.census()).impulse_error,
            mean_of(torques, half),
            most,
            spring,
            bed.free / static_cast<double>(times.size())};
}

/// Keys of a body's shape: a wheel without grousers, a body of revolution.
inline const std::string drum =
    "kind = \"wheel\", radius = 0.1, width = 0.12, wall_thickness = 0.03, grousers = 0, grouser_height = 0.0";

/// Checks docs/verification.md#body-at-rest-on-sand and #momentum-balance, for 1, 10, 100 and 200 substeps.
template<class Exec>
void expect_weight_carried(const Exec& exec, SphereOnBed bed)
{
    double first = 0;
    for (const int substeps : {1, 10, 100, 200})
    {
        bed.substeps       = substeps;
        const Watched body = watch_sphere(exec, bed);
        const auto    with = fmt::format(", N = {}", substeps);
        report("mean force over W" + with, body.lift, 1, 0.01, "docs/verification.md#body-at-rest-on-sand");
        report("its steps' deviation" + with, body.jitter, 0, 1e-3, "docs/verification.md#body-at-rest-on-sand");
        report("impulse error over weight x time" + with, body.impulse, 0, 1e-10,
               "fp64 rounding (docs/verification.md#momentum-balance)");
        EXPECT_NEAR(body.lift, 1, 0.01);
        EXPECT_LT(body.jitter, 1e-3);
        EXPECT_LT(body.impulse, 1e-10);
        if (substeps == 1) { first = body.height; }
        report("depth over that of N = 1" + with, body.height / first, 1, 0.006,
               "docs/verification.md#points-during-the-substeps");
        EXPECT_NEAR(body.height / first, 1, 0.006);
    }
}

} // namespace tread::test
