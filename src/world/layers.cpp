#include "world/layers.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "scene/lines.hpp"
#include "world/cover.hpp"
#include "world/grading.hpp"
#include "world/materials.hpp"
#include "world/rocks.hpp"

namespace tread::world
{
namespace
{

/// Sample positions inside a template, m at scale 1: those of 8 x 8 x 8 in its box that are below its surface.
std::vector<Vec3<double>> samples_of(const shape::ShapeTemplate& form)
{
    constexpr int             each_way = 8;
    const Vec3<double>        step     = form.box.extent() / each_way;
    std::vector<Vec3<double>> samples;
    for (int at = 0; at < each_way * each_way * each_way; ++at)
    {
        const int          i = at % each_way, j = at / each_way % each_way, k = at / (each_way * each_way);
        const Vec3<double> x = form.box.low + step.cwiseProduct(Vec3<double>(i + 0.5, j + 0.5, k + 0.5));
        if (shape::sample(form.sdf, x) < 0) { samples.push_back(x); }
    }
    if (samples.empty()) { samples.push_back(Vec3<double>::Zero()); }
    return samples;
}

/// m, mean over a table's rocks.
double mean_radius(const HostBodies& bodies, std::size_t table)
{
    const std::size_t first = table == 0 ? static_cast<std::size_t>(bodies.named) : bodies.rocks_end[table - 1];
    const std::size_t end   = bodies.rocks_end[table];
    double            sum   = 0;
    for (std::size_t body = first; body < end; ++body) { sum += bodies.radius[body]; }
    return sum / double(std::max<std::size_t>(end - first, 1));
}

constexpr double enough_radii = 2;   ///< rock radius in contact radii of the points: below, check advises finer points
constexpr double enough_pores = 0.1; ///< share of a layer free of contact in which all of its sand points find a place

double radius_of_unit_spacing(const scene::Scene& scene)
{
    return contact::point_radius(1, radius_rule(scene.numerics.point_radius));
}

/// m, spacing without voids: among randomly placed rocks of volume share c, points of radius r find exp(-c (1 +
/// r/R)^3) of the layer free of contact.
double spacing_without_voids(const scene::Scene& scene, const LayerShares& layer)
{
    const double radius = layer.rock_radius * (std::cbrt(-std::log(enough_pores) / layer.rock) - 1);
    const double most   = layer.point_radius / 1.1; // a refused spacing is too coarse, whatever the estimate
    return std::min(std::max(radius, 0.25 * layer.rock_radius), most) / radius_of_unit_spacing(scene);
}

/// Scene keys that give a terrain table this point spacing.
std::string finer_points(const scene::Scene& scene, double spacing)
{
    for (const int each_way : {1, 2, 3, 4})
    {
        if (scene.grid.spacing / each_way <= spacing * (1 + 1e-9))
        {
            return fmt::format("[[terrain]] points_per_cell = {}", each_way * each_way * each_way);
        }
    }
    return "[[terrain]] spacing, of a table for the layer alone";
}

} // namespace

std::vector<double> shares_in_sand(const World& world, const SandMap& sand)
{
    std::vector<std::vector<Vec3<double>>> samples;
    for (const auto& form : world.templates) { samples.push_back(samples_of(form)); }
    const HostBodies&   bodies = world.bodies;
    std::vector<double> share(bodies.size(), 0.0);
#pragma omp parallel for schedule(static)
    for (auto body = static_cast<std::size_t>(bodies.named); body < bodies.size(); ++body)
    {
        const auto&        places = samples[static_cast<std::size_t>(bodies.shape[body])];
        const Mat3<double> turn   = bodies.scale[body] * bodies.orientation[body].toRotationMatrix();
        const auto         inside =
            std::count_if(places.begin(), places.end(),
                          [&](const Vec3<double>& x) { return sand.holds(bodies.position[body] + turn * x); });
        share[body] = double(inside) / double(places.size());
    }
    return share;
}

Layer find_layer(const scene::Scene& scene, std::size_t table, const World& world, const std::vector<double>& in_sand)
{
    const Space       space  = rocks_space(scene, table);
    const HostBodies& bodies = world.bodies;
    const auto        rule   = radius_rule(scene.numerics.point_radius);
    Layer             layer{table, 0, 0, mean_radius(bodies, table), 0, std::vector<bool>(world.sand.size(), false)};
    for_each_point(world.sand,
                   [&](const SandPoint& point)
                   {
                       if (!contains(space, point.position)) { return; }
                       const double volume   = point.kind.volume;
                       layer.holds[point.id] = true;
                       layer.sand += volume;
                       layer.point_radius = std::max(layer.point_radius, contact::point_radius(volume, rule));
                   });
    for (auto body = static_cast<std::size_t>(bodies.named); body < bodies.size(); ++body)
    {
        if (in_sand[body] > 0 && contains(space, bodies.position[body]))
        {
            layer.rock += in_sand[body] * sphere_volume(2 * bodies.radius[body]);
        }
    }
    return layer;
}

LayerShares shares_of(const Layer& layer, const Sand& sand, const std::vector<bool>& kept)
{
    double left = 0;
    for_each_point(sand,
                   [&](const SandPoint& point)
                   {
                       if (layer.holds[point.id] && kept[point.id]) { left += point.kind.volume; }
                   });
    return {layer.table, left / layer.sand, layer.rock / layer.sand, layer.sand, layer.rock_radius, layer.point_radius};
}

void require_no_voids(const scene::Scene& scene, const World& world)
{
    for (const LayerShares& layer : world.layers)
    {
        const scene::Rocks& rocks = scene.rocks[layer.table];
        if (layer.empty() <= most_void || rocks.allow_voids) { continue; }
        const double spacing = spacing_without_voids(scene, layer);
        throw InputError(
            scene::line_of(scene, fmt::format("rocks[{}]", layer.table)) +
            fmt::format("[[rocks]] {} of shape '{}': its layer would hold {:.1f} % sand, {:.1f} % rock and {:.1f} % "
                        "void, as points stay {:.3g} m off rocks of {:.3g} m radius; accepted: at most {:.0f} % void: "
                        "points at most {:.3g} m apart there ({}), or allow_voids = true",
                        layer.table, rocks.shape, 100 * layer.sand, 100 * layer.rock, 100 * layer.empty(),
                        layer.point_radius, layer.rock_radius, 100 * most_void, spacing, finer_points(scene, spacing)));
    }
}

std::vector<std::string> layer_advice(const scene::Scene& scene, const World& world)
{
    std::vector<std::string> lines;
    for (const LayerShares& layer : world.layers)
    {
        if (layer.rock_radius >= enough_radii * layer.point_radius) { continue; }
        const double spacing = layer.rock_radius / enough_radii / radius_of_unit_spacing(scene);
        lines.push_back(fmt::format("advice: rocks {} have a mean radius of {:.2f} contact radii of the points around "
                                    "them ({:.3g} m): sand does not pass between them; {:.0f} want points {:.3g} m "
                                    "apart ({})",
                                    layer.table, layer.rock_radius / layer.point_radius, layer.point_radius,
                                    enough_radii, spacing, finer_points(scene, spacing)));
    }
    return lines;
}

} // namespace tread::world
