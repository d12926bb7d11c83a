#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "backend/vector.hpp"
#include "kernels/dem/contact/rolling_kern.hpp"
#include "kernels/dem/joints/joint.hpp"
#include "kernels/dem/templates.hpp"
#include "kernels/mpm/grid/grid.hpp"
#include "kernels/mpm/pages/order.hpp"
#include "scene/scene.hpp"
#include "shape/template.hpp"
#include "world/sand.hpp"

// The world that a scene describes, built once on the host: identical on every machine and for every backend.
namespace tread::world
{

/// Rigid bodies: first the scene's [[body]] tables in their order, then the rocks.
struct HostBodies
{
    std::vector<Vec3<double>> position;     ///< m, centre of mass
    std::vector<Quat>         orientation;  ///< body to world
    std::vector<Vec3<double>> velocity;     ///< m/s, of named bodies; rocks begin at rest
    std::vector<double>       mass;         ///< kg
    std::vector<double>       scale;        ///< relative to the template
    std::vector<double>       radius;       ///< m, radius of the sphere of equal volume
    std::vector<std::int32_t> shape;        ///< index into World::templates
    std::vector<std::int32_t> material;     ///< index into Scene::materials
    std::int64_t              named = 0;    ///< number of bodies of [[body]] tables
    std::vector<std::size_t>  rocks_end;    ///< for each [[rocks]] table: one past its last body
    std::size_t               released = 0; ///< number of rocks whose description is gone (release_rocks)

    std::size_t size() const { return position.size() + released; }

    /// std::logic_error once rocks have been released: for functions that go through all bodies.
    void require_rocks() const;
};

/// Contact record of a pair: its key (kernels/dem/pairs/pairs.hpp), in which walls are numbered after the bodies. A
/// pair that touches in several patches has a record for each; only then is `place` used.
struct ContactRecord
{
    std::uint64_t key;
    dem::Patch    patch;
    dem::Rolling  rolling = dem::no_rolling();
    Vec3<double>  place   = Vec3<double>::Zero(); ///< m, from the centre of the first body, in its frame
};

/// Composition of a [[rocks]] table's layer at the start, between floor and height as far as sand was there: shares of
/// the volume of that sand.
struct LayerShares
{
    std::size_t table; ///< index into Scene::rocks
    double      sand;
    double      rock;
    double      space;        ///< m3, volume of that sand
    double      rock_radius;  ///< m, mean over the table's rocks: radius of the sphere of equal volume
    double      point_radius; ///< m, largest contact radius of the points there

    double empty() const { return 1 - sand - rock; }
};

struct World
{
    mpm::GridGeometry                 geometry;
    mpm::GridWalls                    grid_walls;
    std::vector<dem::Plane>           planes; ///< walls in contact with bodies
    std::vector<shape::ShapeTemplate> templates;
    Sand                              sand;
    HostBodies                        bodies;
    std::vector<LayerShares>          layers;   ///< for [[rocks]] tables that replace sand
    std::vector<ContactRecord>        contacts; ///< initial contacts of the bodies, by ascending key
    std::vector<dem::Joint>           joints;   ///< of [[joint]] tables, in their order; motors as in the first phase
    double point_spacing;                       ///< m, smallest distance between neighbouring points; 0 without sand
    double middle_diameter;                     ///< m, median of the bodies' diameters; 0 without bodies
};

/// Builds sand, rocks and bodies of a scene; InputError where geometry is impossible: a body or rock that overlaps
/// another, a wall or the sand (unless it replaces it), a shape over 100 times the domain, a region too small.
World build_world(const scene::Scene& scene);

/// Frees the description of the rocks, of which a simulation holds what it needs: each rank that of its own. Named
/// bodies and the number of bodies stay.
void release_rocks(World& world);

/// Side of a contact patch on the bed, m: that of the square of the same area, or, where the domain is narrower than
/// that square (a slab in plane strain), of the rectangle across the domain.
double patch_side(double area, const World& world);

/// Index of a material by its name.
int material_index(const scene::Scene& scene, const std::string& name);

/// Diameter of the sphere of equal volume, m at scale 1 (a wheel's equivalent_radius is that of its rim).
double volume_diameter(const shape::ShapeTemplate& form);

/// Template of a body.
inline const shape::ShapeTemplate& template_of(const World& world, std::size_t body)
{
    return world.templates[static_cast<std::size_t>(world.bodies.shape[body])];
}

/// Index of a template of the world by its name.
std::int32_t template_index(const World& world, const std::string& name);

} // namespace tread::world
