#include "world/on_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "kernels/contact/samples_kern.hpp"
#include "world/body_grid.hpp"
#include "world/cover.hpp"
#include "world/materials.hpp"
#include "world/touch_table.hpp"

namespace tread::world
{
namespace
{

constexpr double closest = 1e-4; ///< gap at which the descent ends, over the body's bounding radius

/// A sand point, and its contact distance (m) from a body.
struct Grain
{
    Vec3<double> position;
    double       reach;
};

/// Sand and rocks that a descending body may touch.
struct GroundBelow
{
    std::vector<Grain>       grains;
    std::vector<std::size_t> rocks;
    double                   top    = -std::numeric_limits<double>::infinity(); ///< m
    double                   bottom = std::numeric_limits<double>::infinity();
};

bool is_under(const World& world, std::size_t body, const Vec3<double>& x, double reach)
{
    const Vec3<double> offset = x - world.bodies.position[body];
    return std::hypot(offset[0], offset[1]) < bounding_radius(world, body) + reach;
}

void count(GroundBelow& ground, double height, double reach)
{
    ground.top    = std::max(ground.top, height + reach);
    ground.bottom = std::min(ground.bottom, height - reach);
}

GroundBelow ground_under(const scene::Scene& scene, const World& world, std::size_t body)
{
    const auto&  form    = template_of(world, body);
    const bool   sampled = world.bodies.scale[body] * form.equivalent_radius < sampled_below(scene, world.sand);
    const double share   = sampled ? 1 + contact::patch_reach : 1.0; // samples lie beside the point's centre
    const auto   rule    = radius_rule(scene.numerics.point_radius);
    const auto   own     = world.bodies.material[body];
    const auto   touch   = touch_table(scene, 0);
    GroundBelow  ground;
    for (const PointRow& row : world.sand.rows)
    {
        const PointKind& kind  = world.sand.kind_of(row);
        const double     reach = share * contact::point_radius(kind.volume, rule);
        if (!touch(kind.material, own)) { continue; }
        for_each_point(world.sand, row,
                       [&](const SandPoint& point)
                       {
                           if (!is_under(world, body, point.position, reach)) { return; }
                           ground.grains.push_back({point.position, reach});
                           count(ground, point.position[2], reach);
                       });
    }
    for (auto rock = static_cast<std::size_t>(world.bodies.named); rock < world.bodies.size(); ++rock)
    {
        const double radius = bounding_radius(world, rock);
        if (!touch(world.bodies.material[rock], own) || !is_under(world, body, world.bodies.position[rock], radius))
        {
            continue;
        }
        ground.rocks.push_back(rock);
        count(ground, world.bodies.position[rock][2], radius);
    }
    return ground;
}

/// Least of `known` (m) and the distances of the surface nodes of `one` from the surface of `other`.
double nodes_off(const World& world, std::size_t one, std::size_t other, double known)
{
    const HostBodies&  bodies = world.bodies;
    const auto&        form   = template_of(world, one);
    const Mat3<double> turn   = bodies.scale[one] * bodies.orientation[one].toRotationMatrix();
    const double       radius = bounding_radius(world, other);
    for (const Vec3<double>& node : form.nodes.positions)
    {
        const Vec3<double> x = bodies.position[one] + turn * node;
        if ((x - bodies.position[other]).norm() - radius < known)
        {
            known = std::min(known, distance(world, other, x));
        }
    }
    return known;
}

/// Least distance (m) of a body from the ground under it; at most `most`.
double clearance(const World& world, std::size_t body, const GroundBelow& ground, double most)
{
    const Vec3<double>& centre = world.bodies.position[body];
    const double        radius = bounding_radius(world, body);
    double              least  = most;
    for (const Grain& grain : ground.grains)
    {
        if ((grain.position - centre).norm() - radius - grain.reach >= least) { continue; }
        least = std::min(least, distance(world, body, grain.position) - grain.reach);
    }
    for (const std::size_t rock : ground.rocks)
    {
        const double apart = (world.bodies.position[rock] - centre).norm() - radius - bounding_radius(world, rock);
        if (apart >= least) { continue; }
        least = nodes_off(world, body, rock, least);
        least = nodes_off(world, rock, body, least);
    }
    return least;
}

} // namespace

/// A body may descend by its distance from everything else. Away from surfaces the stored distance may be too large by
/// a fraction of a cell, or of a brick of cells, so a step uses at most half of it.
void stand_on_surface(const scene::Scene& scene, std::size_t body, double gap, World& world)
{
    const double      radius = bounding_radius(world, body), near = closest * radius;
    const GroundBelow ground = ground_under(scene, world, body);
    double&           height = world.bodies.position[body][2];
    height                   = ground.top + radius;
    while (!ground.grains.empty() || !ground.rocks.empty())
    {
        const double free = clearance(world, body, ground, radius);
        if (free < near)
        {
            height += gap;
            return;
        }
        height -= 0.5 * free;
        if (height < ground.bottom - radius) { break; }
    }
    throw InputError(fmt::format("[[body]] '{}': its position is \"on surface\", and neither sand nor a rock that it "
                                 "touches in the first phase lies under it",
                                 scene.bodies[body].name));
}

} // namespace tread::world
