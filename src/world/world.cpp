#include "world/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "scene/lines.hpp"
#include "world/grading.hpp"
#include "world/joints.hpp"
#include "world/layers.hpp"
#include "world/make_room.hpp"
#include "world/materials.hpp"
#include "world/named_bodies.hpp"
#include "world/refinement.hpp"
#include "world/region.hpp"
#include "world/rocks.hpp"
#include "world/saved_bed.hpp"
#include "world/terrain.hpp"
#include "world/terrain_bins.hpp"

namespace tread::world
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
    case scene::WallKind::rough:
        return mpm::WallRule::rough;
    case scene::WallKind::frictional:
        return mpm::WallRule::frictional;
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
    walls.friction = scene.domain.walls.friction;
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

std::vector<RockDraw> draw_table(const scene::Scene& scene, std::size_t table, const SavedBeds& beds)
{
    if (!scene.rocks[table].from.empty()) { return beds.draws(table); }
    const auto members = rocks_family(scene, table).size();
    return draw_rocks(scene.rocks[table], volume(rocks_space(scene, table)), members);
}

std::vector<std::vector<RockDraw>> draw_all_rocks(const scene::Scene& scene, const SavedBeds& beds)
{
    std::vector<std::vector<RockDraw>> draws;
    for (std::size_t table = 0; table < scene.rocks.size(); ++table)
    {
        draws.push_back(scene::with_line_of(scene, fmt::format("rocks[{}]", table),
                                            [&] { return draw_table(scene, table, beds); }));
    }
    return draws;
}

/// A template needed by bodies or rocks.
struct WantedShape
{
    scene::Shape shape;
    double       smallest; ///< m, diameter of the smallest instance; infinite if all are bodies of the shape's own size
};

/// Shapes used by bodies and drawn rocks, each once, in order of first use.
class WantedShapes
{
public:
    void add(const scene::Shape& shape, double diameter)
    {
        const auto [at, is_new] = index_.try_emplace(shape.name, wanted.size());
        if (is_new) { wanted.push_back({shape, diameter}); }
        WantedShape& one = wanted[at->second];
        one.smallest     = std::min(one.smallest, diameter);
    }

    std::vector<WantedShape> wanted;

private:
    std::map<std::string, std::size_t> index_;
};

std::vector<WantedShape> wanted_shapes(const scene::Scene& scene, const std::vector<std::vector<RockDraw>>& draws)
{
    WantedShapes shapes;
    for (const scene::Body& body : scene.bodies)
    {
        const auto own_size = std::numeric_limits<double>::infinity();
        shapes.add(body_shape(scene, body), body.diameter.value_or(own_size));
    }
    for (std::size_t table = 0; table < scene.rocks.size(); ++table)
    {
        const auto family = rocks_family(scene, table);
        for (const RockDraw& rock : draws[table])
        {
            shapes.add(family[static_cast<std::size_t>(rock.member)], rock.diameter);
        }
    }
    return shapes.wanted;
}

/// Largest contact radius of a point over a body's radius: the body's distance field extends that far.
constexpr double most_point_radii = 8;

/// m at the shape's scale 1, largest contact radius of a point at the smallest instance of a shape: the distance at
/// which contact with sand begins.
double contact_reach(const scene::Scene& scene, const Sand& sand, const WantedShape& wanted, double equivalent_radius)
{
    if (sand.size() == 0) { return 0; }
    const double largest = contact::point_radius(largest_volume(sand), radius_rule(scene.numerics.point_radius));
    const double radius  = std::min(equivalent_radius, 0.5 * wanted.smallest);
    if (largest > most_point_radii * radius)
    {
        throw InputError(fmt::format(
            "[[shape]] '{}': a body of {:.3g} m radius (of the sphere of equal volume) beside points of sand "
            "with a contact radius of {:.3g} m, {:.3g} times its own; accepted: at most {} "
            "times: a larger body, or finer points ([grid] spacing, points_per_cell)",
            wanted.shape.name, radius, largest, largest / radius, most_point_radii));
    }
    return largest / std::min(1.0, 0.5 * wanted.smallest / equivalent_radius);
}

shape::ShapeTemplate make_template(const scene::Scene& scene, const Sand& sand, const WantedShape& wanted)
{
    const auto& size  = scene.domain.size;
    const auto  reach = [&](double equivalent_radius) { return contact_reach(scene, sand, wanted, equivalent_radius); };
    auto        form  = shape::make_template(wanted.shape, scene.directory, reach);
    const double extent = form.box.extent().maxCoeff();
    if (std::isinf(wanted.smallest) && extent > 100 * *std::max_element(size.begin(), size.end()))
    {
        throw InputError(fmt::format("[[shape]] '{}': its extent of {:.4g} m is over 100 times the domain; a mesh in "
                                     "millimetres? then give unit = \"mm\" or unit = 0.001",
                                     wanted.shape.name, extent));
    }
    return form;
}

/// Name of the shape's table, "shape.clast", also for its member "clast-0".
std::string shape_table(const scene::Scene& scene, const std::string& name)
{
    const bool own    = std::any_of(scene.shapes.begin(), scene.shapes.end(),
                                    [&](const scene::Shape& shape) { return shape.name == name; });
    const auto family = own ? name : name.substr(0, name.rfind('-'));
    return "shape." + family;
}

std::vector<shape::ShapeTemplate> make_templates(const scene::Scene& scene, const Sand& sand,
                                                 const std::vector<WantedShape>& wanted)
{
    std::vector<shape::ShapeTemplate> templates;
    templates.reserve(wanted.size());
    for (const WantedShape& one : wanted)
    {
        templates.push_back(scene::with_line_of(scene, shape_table(scene, one.shape.name),
                                                [&] { return make_template(scene, sand, one); }));
    }
    return templates;
}

void add_table(const scene::Scene& scene, std::size_t table, const std::vector<RockDraw>& drawn, SavedBeds& beds,
               World& world)
{
    if (scene.rocks[table].from.empty()) { place_rocks(scene, table, drawn, world); }
    else { beds.place(table, world); }
    world.bodies.rocks_end.push_back(world.bodies.size());
}

void add_rocks(const scene::Scene& scene, const std::vector<std::vector<RockDraw>>& draws, SavedBeds& beds,
               World& world)
{
    for (std::size_t table = 0; table < scene.rocks.size(); ++table)
    {
        scene::with_line_of(scene, fmt::format("rocks[{}]", table),
                            [&] { add_table(scene, table, draws[table], beds, world); });
    }
    beds.finish(world);
    make_room(scene, world);
    require_no_voids(scene, world);
}

/// m, median of the bodies' diameters; 0 without bodies.
double middle_diameter(std::vector<double> radii)
{
    if (radii.empty()) { return 0; }
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    return 2 * *middle;
}

} // namespace

void HostBodies::require_rocks() const
{
    if (released > 0) { throw std::logic_error("the description of the rocks was released"); }
}

void release_rocks(World& world)
{
    HostBodies& bodies = world.bodies;
    const auto  named  = static_cast<std::size_t>(bodies.named);
    const auto  cut    = [named](auto& values)
    {
        values.resize(named);
        values.shrink_to_fit();
    };
    bodies.released += bodies.position.size() - named;
    cut(bodies.position);
    cut(bodies.orientation);
    cut(bodies.mass);
    cut(bodies.scale);
    cut(bodies.radius);
    cut(bodies.shape);
    cut(bodies.material);
}

double patch_side(double area, const World& world)
{
    const double narrow = std::min(world.geometry.size[0], world.geometry.size[1]);
    return std::max(std::sqrt(area), area / narrow);
}

int material_index(const scene::Scene& scene, const std::string& name)
{
    const auto at = std::find_if(scene.materials.begin(), scene.materials.end(),
                                 [&](const auto& material) { return material.name == name; });
    return static_cast<int>(at - scene.materials.begin());
}

double volume_diameter(const shape::ShapeTemplate& form) { return std::cbrt(6 * form.unit.volume / std::numbers::pi); }

std::int32_t template_index(const World& world, const std::string& name)
{
    const auto at = std::find_if(world.templates.begin(), world.templates.end(),
                                 [&](const auto& form) { return form.name == name; });
    return static_cast<std::int32_t>(at - world.templates.begin());
}

World build_world(const scene::Scene& scene)
{
    World      world{};
    const bool linear = scene.numerics.shape_functions == scene::ShapeFunctions::linear;
    world.geometry    = {
           scene.grid.spacing, linear ? 0.0 : 0.5, {scene.domain.size[0], scene.domain.size[1], scene.domain.size[2]}, {}};
    world.geometry.refinement = refinement_of(scene);
    world.grid_walls          = grid_walls(scene);
    world.planes              = body_planes(scene);
    SavedBeds  beds(scene);
    const auto draws    = draw_all_rocks(scene, beds);
    world.sand          = make_terrain(scene, world.geometry.refinement);
    world.point_spacing = terrain_spacing(scene, world.sand);
    world.templates     = make_templates(scene, world.sand, wanted_shapes(scene, draws));
    add_named_bodies(scene, world);
    add_rocks(scene, draws, beds, world);
    require_room_for_columns(scene, world);
    find_heights(scene, world);
    world.middle_diameter = middle_diameter(world.bodies.radius);
    if (!scene.joints.empty()) { world.joints = make_joints(scene, world.bodies); }
    return world;
}

} // namespace tread::world
