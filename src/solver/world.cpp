#include "solver/world.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "solver/materials.hpp"
#include "solver/rocks.hpp"
#include "solver/terrain.hpp"

namespace tread::solver
{
namespace
{

mpm::WallRule wall_rule(scene::WallKind kind)
{
    switch (kind)
    {
    case scene::WallKind::slip:
        return mpm::WallRule::slip;
    case scene::WallKind::fixed:
        return mpm::WallRule::fixed;
    case scene::WallKind::open:
        return mpm::WallRule::open;
    }
    return mpm::WallRule::open;
}

struct Side
{
    int             axis;
    int             end; ///< 0 low, 1 high
    scene::WallKind kind;
};

std::vector<Side> sides(const scene::Walls& walls)
{
    return {{0, 0, walls.x}, {0, 1, walls.x},      {1, 0, walls.y},
            {1, 1, walls.y}, {2, 0, walls.bottom}, {2, 1, walls.top}};
}

mpm::GridWalls grid_walls(const scene::Scene& scene)
{
    mpm::GridWalls walls{};
    for (const Side& side : sides(scene.domain.walls)) { walls.rule[side.axis][side.end] = wall_rule(side.kind); }
    for (std::size_t c = 0; c < 3; ++c)
    {
        walls.last_node[c] = static_cast<std::int32_t>(std::lround(scene.domain.size[c] / scene.grid.spacing));
    }
    return walls;
}

std::vector<dem::Plane> body_planes(const scene::Scene& scene)
{
    std::vector<dem::Plane> planes;
    for (const Side& side : sides(scene.domain.walls))
    {
        if (side.kind == scene::WallKind::open) { continue; }
        Vec3<double> normal = Vec3<double>::Zero();
        normal[side.axis]   = side.end == 0 ? 1 : -1;
        const double at     = side.end == 0 ? 0 : -scene.domain.size[static_cast<std::size_t>(side.axis)];
        planes.push_back({normal, at, side.kind == scene::WallKind::slip});
    }
    return planes;
}

/// The largest radius of a point beside the smallest instance of a shape, m at the shape's scale 1: sand is in contact
/// from that distance on.
double contact_reach(const scene::Scene& scene, const std::string& shape, double equivalent_radius)
{
    double largest = 0;
    for (const scene::Terrain& terrain : scene.terrain)
    {
        const double volume = std::pow(scene.grid.spacing, 3) / terrain.points_per_cell;
        largest = std::max(largest, contact::point_radius(volume, radius_rule(scene.numerics.point_radius)));
    }
    double smallest_scale = 1;
    for (const scene::Rocks& rocks : scene.rocks)
    {
        if (rocks.shape == shape)
        {
            smallest_scale = std::min(smallest_scale, 0.5 * rocks.diameter / equivalent_radius);
        }
    }
    return largest / smallest_scale;
}

/// The templates that bodies and rocks name, each once, in order of first use.
std::vector<shape::ShapeTemplate> make_templates(const scene::Scene& scene)
{
    std::vector<std::string> names;
    const auto               use = [&](const std::string& name)
    {
        if (std::find(names.begin(), names.end(), name) == names.end()) { names.push_back(name); }
    };
    for (const auto& body : scene.bodies) { use(body.shape); }
    for (const auto& rocks : scene.rocks) { use(rocks.shape); }
    std::vector<shape::ShapeTemplate> templates;
    const auto&                       size = scene.domain.size;
    for (const std::string& name : names)
    {
        const auto reach = [&](double equivalent_radius) { return contact_reach(scene, name, equivalent_radius); };
        templates.push_back(shape::make_template(shape::find_shape(scene, name), scene.directory, reach));
        const double extent = templates.back().box.extent().maxCoeff();
        if (std::find_if(scene.bodies.begin(), scene.bodies.end(), [&](const auto& b) { return b.shape == name; }) !=
                scene.bodies.end() &&
            extent > 100 * *std::max_element(size.begin(), size.end()))
        {
            throw InputError(
                fmt::format("[[shape]] '{}': its extent of {:.4g} m is over 100 times the domain; a mesh in "
                            "millimetres? then give unit = \"mm\" or unit = 0.001",
                            name, extent));
        }
    }
    return templates;
}

double body_mass(const scene::Scene& scene, const scene::Body& body, const shape::ShapeTemplate& form)
{
    if (body.mass) { return *body.mass; }
    if (body.load)
    {
        const auto& g = scene.domain.gravity;
        return *body.load / Vec3<double>(g[0], g[1], g[2]).norm();
    }
    return *body.density * form.unit.volume;
}

/// Lowest and highest corner of a body in the world, from its mesh.
shape::Bounds world_bounds(const shape::ShapeTemplate& form, const Vec3<double>& at)
{
    return {form.box.low + at, form.box.high + at};
}

void require_clear_of_walls(const scene::Body& body, const shape::ShapeTemplate& form, const World& world)
{
    const auto box = world_bounds(form, {body.position[0], body.position[1], body.position[2]});
    for (const dem::Plane& plane : world.planes)
    {
        double nearest = 0;
        for (int c = 0; c < 3; ++c) { nearest += plane.normal[c] * (plane.normal[c] > 0 ? box.low[c] : box.high[c]); }
        if (nearest < plane.offset)
        {
            throw InputError(
                fmt::format("[[body]] '{}': position [{}, {}, {}] puts it {:.4g} m into a wall of the domain",
                            body.name, body.position[0], body.position[1], body.position[2], plane.offset - nearest));
        }
    }
}

void add_body(const scene::Scene& scene, const scene::Body& body, World& world)
{
    const auto at    = std::find_if(world.templates.begin(), world.templates.end(),
                                    [&](const auto& form) { return form.name == body.shape; });
    const auto shape = static_cast<std::int32_t>(at - world.templates.begin());
    require_clear_of_walls(body, *at, world);
    HostBodies& bodies = world.bodies;
    bodies.position.emplace_back(body.position[0], body.position[1], body.position[2]);
    bodies.orientation.push_back(Quat::Identity());
    bodies.velocity.emplace_back(body.velocity[0], body.velocity[1], body.velocity[2]);
    bodies.mass.push_back(body_mass(scene, body, *at));
    bodies.scale.push_back(1);
    bodies.radius.push_back(at->equivalent_radius);
    bodies.shape.push_back(shape);
    bodies.material.push_back(material_index(scene, body.material));
    bodies.named = static_cast<std::int64_t>(bodies.size());
}

void require_clear_of_sand(const scene::Scene& scene, World& world)
{
    for (std::size_t b = 0; b < static_cast<std::size_t>(world.bodies.named); ++b)
    {
        const std::int64_t inside = remove_points_in_body(scene, world, b);
        if (inside > 0)
        {
            throw InputError(
                fmt::format("[[body]] '{}': {} points of sand stand inside it or within their radius of it; "
                            "raise position[2] or lower the terrain",
                            scene.bodies[b].name, inside));
        }
    }
}

} // namespace

int material_index(const scene::Scene& scene, const std::string& name)
{
    const auto at = std::find_if(scene.materials.begin(), scene.materials.end(),
                                 [&](const auto& material) { return material.name == name; });
    return static_cast<int>(at - scene.materials.begin());
}

World build_world(const scene::Scene& scene)
{
    World      world{};
    const bool linear = scene.numerics.shape_functions == scene::ShapeFunctions::linear;
    world.geometry    = {
           scene.grid.spacing, linear ? 0.0 : 0.5, {scene.domain.size[0], scene.domain.size[1], scene.domain.size[2]}};
    world.grid_walls    = grid_walls(scene);
    world.planes        = body_planes(scene);
    world.templates     = make_templates(scene);
    world.points        = make_terrain(scene);
    world.point_spacing = terrain_spacing(scene);
    for (const scene::Body& body : scene.bodies) { add_body(scene, body, world); }
    require_clear_of_sand(scene, world);
    for (const scene::Rocks& rocks : scene.rocks) { place_rocks(scene, rocks, world); }
    set_geostatic_stress(scene, world.bodies, world.points);
    return world;
}

} // namespace tread::solver
