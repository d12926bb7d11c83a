#include "world/named_bodies.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "scene/lines.hpp"
#include "world/body_grid.hpp"
#include "world/cover.hpp"
#include "world/on_surface.hpp"
#include "world/orientation.hpp"
#include "world/touch_table.hpp"

namespace tread::world
{
namespace
{

constexpr double deepest_at_start = 0.1; ///< overlap over the smaller radius that causes no warning

double body_scale(const scene::Body& body, const shape::ShapeTemplate& form)
{
    return body.diameter ? *body.diameter / volume_diameter(form) : 1;
}

double body_mass(const scene::Scene& scene, const scene::Body& body, const shape::ShapeTemplate& form)
{
    if (body.mass) { return *body.mass; }
    if (body.load)
    {
        const auto& g = scene.domain.gravity;
        return *body.load / Vec3<double>(g[0], g[1], g[2]).norm();
    }
    return *body.density * form.unit.volume * std::pow(body_scale(body, form), 3);
}

std::string body_table(const scene::Body& body) { return "body." + body.name; }

void require_clear_of_walls(const scene::Scene& scene, std::size_t index, const World& world)
{
    const scene::Body& body  = scene.bodies[index];
    const TouchTable   touch = touch_table(scene, 0);
    if (!touch(world.bodies.material[index], touch.wall())) { return; }
    const Vec3<double>& at     = world.bodies.position[index];
    const double        scale  = world.bodies.scale[index];
    const shape::Bounds turned = turned_box(world, index);
    const shape::Bounds box{scale * turned.low + at, scale * turned.high + at};
    for (const dem::Plane& plane : world.planes)
    {
        double nearest = 0;
        for (int c = 0; c < 3; ++c) { nearest += plane.normal[c] * (plane.normal[c] > 0 ? box.low[c] : box.high[c]); }
        if (nearest < plane.offset)
        {
            throw InputError(fmt::format(
                "[[body]] '{}': position [{}, {}, {}]{} puts it {:.4g} m into a wall of the domain", body.name, at[0],
                at[1], at[2], body.on_surface ? " (\"on surface\")" : "", plane.offset - nearest));
        }
    }
}

/// m, height at which a body waits until its height is found: above all others, each above the one before.
double out_of_the_way(const scene::Scene& scene, std::size_t number)
{
    const auto&      size = scene.domain.size;
    constexpr double far  = 1000;
    return far * (*std::max_element(size.begin(), size.end())) * static_cast<double>(number);
}

void add_body(const scene::Scene& scene, const scene::Body& body, World& world)
{
    const std::int32_t shape  = template_index(world, body_shape(scene, body).name);
    const auto&        form   = world.templates[static_cast<std::size_t>(shape)];
    const double       scale  = body_scale(body, form);
    HostBodies&        bodies = world.bodies;
    bodies.position.emplace_back(body.position[0], body.position[1], body.position[2]);
    if (body.on_surface) { bodies.position.back()[2] = out_of_the_way(scene, bodies.size()); }
    bodies.orientation.push_back(rotation_of(body.orientation));
    bodies.velocity.emplace_back(body.velocity[0], body.velocity[1], body.velocity[2]);
    bodies.mass.push_back(body_mass(scene, body, form));
    bodies.scale.push_back(scale);
    bodies.radius.push_back(scale * form.equivalent_radius);
    bodies.shape.push_back(shape);
    bodies.material.push_back(material_index(scene, body.material));
    bodies.named = static_cast<std::int64_t>(bodies.size());
    if (!body.on_surface) { require_clear_of_walls(scene, bodies.size() - 1, world); }
}

void require_clear_of_sand(const scene::Scene& scene, const World& world)
{
    const std::vector<std::int64_t> inside = covered_points(scene, world);
    for (std::size_t b = 0; b < inside.size(); ++b)
    {
        if (inside[b] > 0)
        {
            throw InputError(
                scene::line_of(scene, body_table(scene.bodies[b])) +
                fmt::format("[[body]] '{}': {} points of sand stand inside it or within their radius of it; "
                            "raise position[2] or lower the terrain",
                            scene.bodies[b].name, inside[b]));
        }
    }
}

/// Whether all surface nodes of `one` are within `margin` (m) of the surface of `other`.
bool clings(const World& world, std::size_t one, std::size_t other, double margin)
{
    const HostBodies& bodies = world.bodies;
    const auto&       nodes  = template_of(world, one).nodes.positions;
    return std::all_of(nodes.begin(), nodes.end(),
                       [&](const Vec3<double>& node)
                       {
                           const Vec3<double> turned = bodies.orientation[one] * (bodies.scale[one] * node);
                           return std::abs(distance(world, other, bodies.position[one] + turned)) < margin;
                       });
}

/// Coincident bodies overlap although no node is inside the other: all are on its surface.
bool overlap(const World& world, std::size_t one, std::size_t other)
{
    const double deepest = deepest_at_start * std::min(world.bodies.radius[one], world.bodies.radius[other]);
    return !apart(world, one, other, -deepest) ||
           (clings(world, one, other, deepest) && clings(world, other, one, deepest));
}

/// Whether a joint ties two bodies, which then do not touch.
bool are_jointed(const scene::Scene& scene, std::size_t a, std::size_t b)
{
    const std::string &one = scene.bodies[a].name, &other = scene.bodies[b].name;
    return std::any_of(scene.joints.begin(), scene.joints.end(),
                       [&](const scene::Joint& joint)
                       {
                           const auto& sides = joint.between;
                           return joint.type != scene::JointType::spring &&
                                  ((sides[0] == one && sides[1] == other) || (sides[0] == other && sides[1] == one));
                       });
}

void require_clear_of_each_other(const scene::Scene& scene, const World& world)
{
    const TouchTable touch = touch_table(scene, 0);
    for (std::size_t b = 1; b < scene.bodies.size(); ++b)
    {
        for (std::size_t a = 0; a < b; ++a)
        {
            const double far = bounding_radius(world, a) + bounding_radius(world, b);
            if ((world.bodies.position[a] - world.bodies.position[b]).norm() > far || are_jointed(scene, a, b) ||
                !touch(world.bodies.material[a], world.bodies.material[b]) || !overlap(world, a, b))
            {
                continue;
            }
            throw InputError(
                scene::line_of(scene, body_table(scene.bodies[b])) +
                fmt::format("[[body]] '{}': its position puts it into '{}', by more than {} of the smaller "
                            "one's radius",
                            scene.bodies[b].name, scene.bodies[a].name, deepest_at_start));
        }
    }
}

void require_clear(const scene::Scene& scene, const World& world)
{
    require_clear_of_each_other(scene, world);
    require_clear_of_sand(scene, world);
}

} // namespace

void add_named_bodies(const scene::Scene& scene, World& world)
{
    for (const scene::Body& body : scene.bodies)
    {
        scene::with_line_of(scene, body_table(body), [&] { add_body(scene, body, world); });
    }
    require_clear(scene, world);
}

void find_heights(const scene::Scene& scene, World& world)
{
    bool any = false;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    {
        const scene::Body& body = scene.bodies[b];
        if (!body.on_surface) { continue; }
        scene::with_line_of(scene, body_table(body),
                            [&]
                            {
                                stand_on_surface(scene, b, body.gap, world);
                                require_clear_of_walls(scene, b, world);
                            });
        any = true;
    }
    if (any) { require_clear(scene, world); }
}

scene::Shape body_shape(const scene::Scene& scene, const scene::Body& body)
{
    return shape::members(shape::find_shape(scene, body.shape)).front();
}

} // namespace tread::world
