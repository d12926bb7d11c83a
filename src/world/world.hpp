#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "backend/vector.hpp"
#include "kernels/dem/contact/rolling_kern.hpp"
#include "kernels/dem/templates.hpp"
#include "kernels/mpm/grid/grid.hpp"
#include "kernels/mpm/pages/order.hpp"
#include "scene/scene.hpp"
#include "shape/template.hpp"

// What a scene describes, built once on the host: the same on every machine and for every backend.
namespace tread::world
{

/// Material points before they are given to a backend. One entry a point in every array.
struct HostPoints
{
    std::vector<Vec3<double>> position; ///< m
    std::vector<double>       volume;   ///< m3
    std::vector<double>       mass;     ///< kg
    std::vector<Sym3<double>> stress;   ///< Pa
    std::vector<std::uint8_t> material;
    std::vector<std::int32_t> terrain;  ///< index of the [[terrain]] table that made it
    std::vector<Vec3<double>> velocity; ///< m/s; empty if all points are at rest

    std::vector<double> plastic_shear; ///< that points of a saved bed start with; empty without such points

    /// Of points that are one rank's own alone, their numbers in the scene. Empty: all of the scene, as they stand.
    std::vector<std::uint32_t> id;

    std::size_t size() const { return position.size(); }
};

/// Keeps the points for which kept[i] is not 0, in their order; returns how many went.
std::int64_t keep_points(HostPoints& points, const std::vector<std::uint8_t>& kept);

/// Rigid bodies: first the scene's [[body]] tables in their order, then the rocks.
struct HostBodies
{
    std::vector<Vec3<double>> position;    ///< m, centre of mass
    std::vector<Quat>         orientation; ///< body to world
    std::vector<Vec3<double>> velocity;    ///< m/s
    std::vector<double>       mass;        ///< kg
    std::vector<double>       scale;       ///< of the template
    std::vector<double>       radius;      ///< m, of the sphere of equal volume
    std::vector<std::int32_t> shape;       ///< of World::templates
    std::vector<std::int32_t> material;    ///< of Scene::materials
    std::int64_t              named = 0;   ///< bodies of [[body]] tables
    std::vector<std::size_t>  rocks_end;   ///< of each [[rocks]] table: one past its last body

    std::size_t size() const { return position.size(); }
};

/// What a pair in contact remembers: the key of kernels/dem/pairs/pairs.hpp, walls counted on from the bodies. A pair
/// that touches in several patches has a record for each, and only then their places count.
struct ContactRecord
{
    std::uint64_t key;
    dem::Patch    patch;
    dem::Rolling  rolling = dem::no_rolling();
    Vec3<double>  place   = Vec3<double>::Zero(); ///< m, from the centre of the first body in its frame
};

/// What a [[rocks]] table's region holds at the start between floor and height, as far as sand stood there: shares of
/// the volume of that sand.
struct LayerShares
{
    std::size_t table; ///< of Scene::rocks
    double      sand;
    double      rock;
    double      space;        ///< m3, of the sand that stood there
    double      rock_radius;  ///< m, mean of the table's rocks: of the sphere of equal volume
    double      point_radius; ///< m, largest contact radius of the points there

    double empty() const { return 1 - sand - rock; }
};

struct World
{
    mpm::GridGeometry                 geometry;
    mpm::GridWalls                    grid_walls;
    std::vector<dem::Plane>           planes; ///< walls as bodies meet them
    std::vector<shape::ShapeTemplate> templates;
    HostPoints                        points;
    HostBodies                        bodies;
    std::vector<LayerShares>          layers;        ///< of the [[rocks]] tables that take the place of sand
    std::vector<ContactRecord>        contacts;      ///< that the bodies start with, by ascending key
    double                            point_spacing; ///< m, smallest distance of neighbouring points; 0 without sand
};

/// Builds points, rocks and bodies of a scene; InputError where geometry is impossible: a body or rock that overlaps
/// another, a wall or the sand (unless it replaces it), a shape over 100 times the domain, a region too small.
World build_world(const scene::Scene& scene);

/// Side of a contact patch on the bed, m: of the square of the same area, or, where the domain is narrower than that
/// square (a slab in plane strain), of the rectangle across the domain.
double patch_side(double area, const World& world);

/// Index of a material by its name.
int material_index(const scene::Scene& scene, const std::string& name);

/// Diameter of the sphere of equal volume, m at scale 1 (a wheel's equivalent_radius is that of its rim).
double volume_diameter(const shape::ShapeTemplate& form);

/// Index of a template of the world by its name.
std::int32_t template_index(const World& world, const std::string& name);

} // namespace tread::world
