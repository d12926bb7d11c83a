#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "run/phase_commands.hpp"
#include "run/plausibility.hpp"
#include "run/warnings.hpp"
#include "world/footing.hpp"

namespace tread::run
{
namespace
{

/// A named body and its ground, for the checks below.
struct Placed
{
    const scene::Scene&   scene;
    const world::World&   world;
    const scene::Body&    body;
    const world::Footing& footing;
    std::string           table; ///< name for scene::line_of

    std::string                 name() const { return fmt::format("[[body]] '{}'", body.name); }
    double                      mass() const { return world.bodies.mass[footing.body]; }
    const shape::ShapeTemplate& form() const { return world::template_of(world, footing.body); }
};

/// Extent of the sand in the plan, "x 0 to 1 m, y 0 to 0.6 m".
std::string plan_text(const world::Sand& sand)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3<double>     low = Vec3<double>::Constant(infinity), high = -low;
    for (const world::PointRow& row : sand.rows)
    {
        low  = low.cwiseMin(row.at(0));
        high = high.cwiseMax(row.at(row.count - 1));
    }
    return fmt::format("x {:.3g} to {:.3g} m, y {:.3g} to {:.3g} m", low[0], high[0], low[1], high[1]);
}

/// Warns of a wheel, or any body that a phase drives, without sand below it.
void check_place(const Placed& placed, Warnings& warnings)
{
    const world::Footing& footing = placed.footing;
    if (placed.world.sand.size() == 0 || footing.ground) { return; }
    if (!footing.driven && !placed.form().is_wheel) { return; }
    const auto& at = placed.world.bodies.position[footing.body];
    warnings.add(placed.table, fmt::format("{}: no sand lies under it: it stands at x = {:.4g}, y = {:.4g} m, the sand "
                                           "fills {}",
                                           placed.name(), at[0], at[1], plan_text(placed.world.sand)));
}

/// Bed width required beside a body, m. At a free edge half its width. Beside a wall a quarter of it, or less where
/// the body sinks little: sinkage pushes the sand beside it up along a plane that rises at 45 degrees minus half the
/// friction angle, and a wall beyond that wedge has no effect.
double wanted_beside(const Placed& placed)
{
    const world::Footing& footing = placed.footing;
    if (!footing.ground->walled) { return 0.5 * footing.width; }
    const auto&  soil  = placed.scene.materials[static_cast<std::size_t>(footing.ground->material)];
    const double angle = std::numbers::pi / 4 + 0.5 * soil.friction_angle_deg * std::numbers::pi / 180;
    const double wedge = footing.patch->sinkage * std::tan(angle);
    return std::min(0.25 * footing.width, std::max(wedge, placed.scene.grid.spacing));
}

/// A wheel that fills its bed from wall to wall is an intended plane-strain experiment.
void check_beside(const Placed& placed, Warnings& warnings)
{
    const world::Footing& footing = placed.footing;
    if (!footing.ground || !footing.patch) { return; }
    const double beside = footing.ground->beside, spacing = placed.scene.grid.spacing;
    const bool   fills = std::abs(beside) < spacing && placed.scene.domain.size[1] < footing.width + 3 * spacing;
    if (fills || beside >= wanted_beside(placed)) { return; }
    warnings.add(placed.table,
                 fmt::format("{}: {:.4g} m of bed lie beside its side ({:.4g} m wide), {:.4g} m would keep walls and "
                             "edges away: a wider bed, or position[1] in its middle",
                             placed.name(), beside, footing.width, 0.5 * footing.width));
}

/// Where the bed is thinner than half the breadth of the patch, the floor carries over 80 % of the pressure above it
/// (Boussinesq's strip: 82 %), so that the wheel rests on the floor more than on the sand.
void check_depth(const Placed& placed, Warnings& warnings)
{
    const world::Footing& footing = placed.footing;
    if (!footing.ground || !footing.patch) { return; }
    const double breadth = std::min(footing.patch->length, footing.patch->width);
    const double depth   = footing.ground->depth;
    if (depth >= 0.5 * breadth) { return; }
    warnings.add(placed.table,
                 fmt::format("{}: the bed under it is {:.4g} m deep, under half the breadth of its contact patch "
                             "({:.3g} m): it stands on the floor; {:.3g} m would carry it",
                             placed.name(), depth, breadth, footing.width));
}

/// Compares the mean density in the body's box with the bed's. Wheels of solid metal and of empty rims are within a
/// factor of twenty of sand; 300 detects errors by 1e3.
void check_weight(const Placed& placed, Warnings& warnings)
{
    constexpr double      far     = 300;
    const world::Footing& footing = placed.footing;
    if (!footing.ground || footing.load <= 0) { return; }
    const auto&  soil    = placed.scene.materials[static_cast<std::size_t>(footing.ground->material)];
    const double scale   = placed.world.bodies.scale[footing.body];
    const double density = placed.mass() / (placed.form().box.extent().prod() * std::pow(scale, 3));
    const double ratio   = density / soil.density;
    if (ratio <= far && ratio >= 1 / far)
    {
        if (!footing.patch || footing.patch->carried) { return; }
        warnings.add(placed.table, fmt::format("{}: {:.4g} N ({:.4g} kg) are more than the bed bears before the body "
                                               "stands in it up to its axle: a lighter body or a firmer soil is meant",
                                               placed.name(), footing.load, placed.mass()));
        return;
    }
    const double factor = ratio > 1 ? 1e-3 : 1e3;
    warnings.add(placed.table,
                 fmt::format("{}: {:.4g} kg ({:.4g} N) make its box {:.3g} times as dense as '{}'; {:.4g} "
                             "kg ({:.4g} N) seem meant",
                             placed.name(), placed.mass(), footing.load, ratio, soil.name, factor * placed.mass(),
                             factor * footing.load));
}

void check_density(const Placed& placed, Warnings& warnings)
{
    constexpr double least = 0.5, most = 30; // g/cm3: a rover wheel's density may be chosen to give its load
    if (!placed.body.density || *placed.body.density < least || *placed.body.density > most) { return; }
    warnings.add(placed.table, fmt::format("{}: density = {:.4g} kg/m3; {:.4g} seems meant (given in g/cm3?)",
                                           placed.name(), *placed.body.density, 1000 * *placed.body.density));
}

/// The distance between drum and grouser tips is some 15 % of the radius.
void check_rolling_radius(const Placed& placed, Warnings& warnings)
{
    constexpr double far = 1.25;
    if (!placed.body.rolling_radius) { return; }
    const double ratio = *placed.body.rolling_radius / placed.footing.radius;
    if (ratio <= far && ratio >= 1 / far) { return; }
    warnings.add(placed.table,
                 fmt::format("{}: rolling_radius = {:.4g} m is {:.3g} times the shape's; {:.4g} seems meant",
                             placed.name(), *placed.body.rolling_radius, ratio, placed.footing.radius));
}

/// Warns of a drop of more than a metre and four radii.
void check_gap(const Placed& placed, Warnings& warnings)
{
    const world::Footing& footing = placed.footing;
    const double          gravity = footing.load / placed.mass();
    if (!footing.gap || gravity == 0 || *footing.gap <= std::max(1.0, 4 * footing.radius)) { return; }
    const double z = placed.world.bodies.position[footing.body][2];
    warnings.add(placed.table, fmt::format("{}: it hangs {:.3g} m above the ground and would land at {:.3g} m/s; "
                                           "position[2] = {:.4g} seems meant",
                                           placed.name(), *footing.gap, std::sqrt(2 * gravity * *footing.gap),
                                           z - *footing.gap + 0.005));
}

void check_size(const Placed& placed, Warnings& warnings)
{
    constexpr double least = 0.01, most = 3; // m, radius of driven bodies
    const double     radius = placed.footing.radius;
    if (!placed.footing.driven || (radius >= least && radius <= most)) { return; }
    warnings.add(placed.table, fmt::format("{}: a driven wheel of {:.4g} m radius; {:.4g} m seems meant (given in mm?)",
                                           placed.name(), radius, radius > most ? 1e-3 * radius : 1e3 * radius));
}

/// Compares the speed of the rim with those of rovers and test rigs (under 1 m/s).
void check_spin(const Placed& placed, Warnings& warnings)
{
    constexpr double most = 10; // m/s
    for (const scene::Phase& phase : placed.scene.phases)
    {
        if (!phase.drive || phase.drive->body != placed.body.name) { continue; }
        const double spin = phase.drive->angular_velocity, speed = std::abs(spin) * placed.footing.radius;
        if (speed <= most) { continue; }
        warnings.add("phase." + phase.name,
                     fmt::format("[[phase]] '{}': angular_velocity = {:.4g} rad/s moves the rim at {:.3g} m/s; {:.4g} "
                                 "seems meant (given in degrees/s?) or {:.4g} (in rev/min?)",
                                 phase.name, spin, speed, spin * std::numbers::pi / 180, spin * std::numbers::pi / 30));
    }
}

/// Warns of a patch smaller than a cell, which the grid cannot resolve.
void check_cells(const Placed& placed, Warnings& warnings)
{
    const auto& patch = placed.footing.patch;
    if (!placed.footing.driven || !patch || !patch->carried) { return; }
    const double side  = world::patch_side(patch->area(), placed.world);
    const double cells = side / placed.scene.grid.finest();
    if (cells >= 1) { return; }
    warnings.add(placed.table,
                 fmt::format("{}: its contact patch of {:.3g} x {:.3g} m is {:.2g} cells across: a grid of "
                             "{:.2g} m would have 6",
                             placed.name(), patch->length, patch->width, cells, side / 6));
}

} // namespace

std::vector<Warning> implausible_bodies(const scene::Scene& scene, const world::World& world)
{
    Warnings warnings(scene);
    for (const world::Footing& footing : world::footings(scene, world))
    {
        const scene::Body& body = scene.bodies[footing.body];
        const Placed       placed{scene, world, body, footing, "body." + body.name};
        for (const auto& check : {check_place, check_beside, check_depth, check_weight, check_density,
                                  check_rolling_radius, check_gap, check_size, check_spin, check_cells})
        {
            check(placed, warnings);
        }
    }
    return warnings.take();
}

} // namespace tread::run
