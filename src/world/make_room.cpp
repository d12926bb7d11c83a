#include "world/make_room.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "scene/lines.hpp"
#include "world/grading.hpp"
#include "world/layers.hpp"
#include "world/push_out.hpp"
#include "world/reached_cells.hpp"
#include "world/touch_table.hpp"

namespace tread::world
{
namespace
{

/// A point within the contact radius of a rock.
struct Touch
{
    std::size_t body;
    double      distance; ///< m, signed distance of the point's centre from the surface
    std::size_t point;

    bool operator<(const Touch& other) const
    {
        return std::tie(body, distance, point) < std::tie(other.body, other.distance, other.point);
    }
};

/// Index of each body's [[rocks]] table; -1 for named bodies.
std::vector<std::int32_t> tables_of(const HostBodies& bodies)
{
    std::vector<std::int32_t> table(static_cast<std::size_t>(bodies.named), -1);
    for (std::size_t rocks = 0; rocks < bodies.rocks_end.size(); ++rocks)
    {
        table.resize(bodies.rocks_end[rocks], static_cast<std::int32_t>(rocks));
    }
    return table;
}

/// Whether rocks and points come from one saved bed.
bool settled_together(const scene::Rocks& rocks, const scene::Terrain& terrain)
{
    return !rocks.from.empty() && rocks.from == terrain.from;
}

/// Finds all contacts of points with rocks, ordered by rock, the deepest first.
std::vector<Touch> find_touches(const scene::Scene& scene, const World& world, const BodyGrid& grid,
                                const PointReach& reach)
{
    const auto         table = tables_of(world.bodies);
    const TouchTable   touch = touch_table(scene, 0);
    const ReachedCells cells(world, reach.farthest(world.sand));
    std::vector<Touch> touches;
    const auto         find = [&](const SandPoint& point, std::vector<Touch>& found)
    {
        const Vec3<double>& x = point.position;
        if (!cells.may_be_near(x)) { return; }
        const double radius = reach.radius(point.kind.volume);
        const auto&  own    = scene.terrain[static_cast<std::size_t>(point.kind.terrain)];
        grid.any_near(x, reach.search(radius),
                      [&](std::size_t body)
                      {
                          const auto rocks = table[body];
                          if (rocks >= 0 && touch(point.kind.material, world.bodies.material[body]) &&
                              !settled_together(scene.rocks[static_cast<std::size_t>(rocks)], own) &&
                              nearest_place(world, reach, body, x, radius).distance < radius)
                          {
                              found.push_back({body, distance(world, body, x), point.id});
                          }
                          return false;
                      });
    };
#pragma omp parallel
    {
        std::vector<Touch> mine;
#pragma omp for schedule(dynamic, 16)
        for (const PointRow& row : world.sand.rows)
        {
            for_each_point(world.sand, row, [&](const SandPoint& point) { find(point, mine); });
        }
#pragma omp critical
        touches.insert(touches.end(), mine.begin(), mine.end());
    }
    std::sort(touches.begin(), touches.end());
    // A body may be visited twice.
    const auto same = [](const Touch& a, const Touch& b) { return a.body == b.body && a.point == b.point; };
    touches.erase(std::unique(touches.begin(), touches.end(), same), touches.end());
    return touches;
}

void refuse_sand_in_the_way(const scene::Scene& scene, const World& world, const std::vector<Touch>& touches)
{
    const auto                            table = tables_of(world.bodies);
    std::vector<std::vector<std::size_t>> points(scene.rocks.size());
    for (const Touch& touch : touches) { points[static_cast<std::size_t>(table[touch.body])].push_back(touch.point); }
    for (std::size_t rocks = 0; rocks < points.size(); ++rocks)
    {
        auto& own = points[rocks];
        if (own.empty() || takes_sand(scene.rocks[rocks].placement)) { continue; }
        std::sort(own.begin(), own.end());
        const auto count = std::unique(own.begin(), own.end()) - own.begin();
        throw InputError(scene::line_of(scene, fmt::format("rocks[{}]", rocks)) +
                         fmt::format("[[rocks]] {} of shape '{}': {} points of sand stand where rocks are placed; use "
                                     "placement = \"replace\" or another region",
                                     rocks, scene.rocks[rocks].shape, count));
    }
}

/// Orders rocks in rows as wide as a grid cell, so that the rest of a point's volume is carried over to a nearby rock.
std::vector<std::size_t> in_rows(const World& world)
{
    std::vector<std::size_t> order;
    for (auto body = static_cast<std::size_t>(world.bodies.named); body < world.bodies.size(); ++body)
    {
        order.push_back(body);
    }
    const auto row = [&](std::size_t body)
    {
        const Vec3<double> x = world.bodies.position[body] / world.geometry.spacing;
        return std::tuple(std::floor(x[2]), std::floor(x[1]), x[0]);
    };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return row(a) < row(b); });
    return order;
}

/// Returns false for removed points: of each rock the deepest, up to the volume of the rock that lies in sand.
std::vector<bool> keep_all_but_rock_volume(const World& world, const std::vector<Touch>& touches,
                                           const std::vector<double>& in_sand)
{
    std::vector<bool> kept(world.sand.size(), true);
    double            due = 0; // m3, volume still to be removed
    for (const std::size_t body : in_rows(world))
    {
        due += in_sand[body] * sphere_volume(2 * world.bodies.radius[body]);
        auto touch = std::lower_bound(touches.begin(), touches.end(), body,
                                      [](const Touch& one, std::size_t b) { return one.body < b; });
        for (; touch != touches.end() && touch->body == body; ++touch)
        {
            const double volume = point_of(world.sand, touch->point).kind.volume;
            if (due < 0.5 * volume) { break; }
            if (!kept[touch->point]) { continue; }
            kept[touch->point] = false;
            due -= volume;
        }
    }
    return kept;
}

/// Touching points, each once, by ascending id.
std::vector<PointChange> changes_of(const std::vector<Touch>& touches)
{
    std::vector<std::size_t> touching(touches.size());
    std::transform(touches.begin(), touches.end(), touching.begin(), [](const Touch& touch) { return touch.point; });
    std::sort(touching.begin(), touching.end());
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
    std::vector<PointChange> changes(touching.size());
    std::transform(touching.begin(), touching.end(), changes.begin(),
                   [](std::size_t point) {
                       return PointChange{point, {}};
                   });
    return changes;
}

/// Pushes the touching points that are kept off the bodies; removes the others, and those that find no place.
std::vector<PointChange> push_off(const Surroundings& near, const std::vector<Touch>& touches, std::vector<bool>& kept)
{
    std::vector<PointChange> changes = changes_of(touches);
#pragma omp parallel for schedule(dynamic, 64)
    for (PointChange& change : changes)
    {
        if (kept[change.id]) { change.place = free_place(near, point_of(near.world.sand, change.id)); }
    }
    for (const PointChange& change : changes) { kept[change.id] = change.place.has_value(); }
    return changes;
}

/// Whether rocks of this table replace sand.
bool makes_room(const scene::Scene& scene, const scene::Rocks& rocks)
{
    return takes_sand(rocks.placement) &&
           std::none_of(scene.terrain.begin(), scene.terrain.end(),
                        [&](const scene::Terrain& terrain) { return settled_together(rocks, terrain); });
}

} // namespace

void make_room(const scene::Scene& scene, World& world)
{
    if (world.sand.size() == 0 || scene.rocks.empty()) { return; }
    BodyGrid grid(world);
    for (std::size_t body = 0; body < world.bodies.size(); ++body) { grid.add(body); }
    const PointReach reach   = make_point_reach(scene, world.sand);
    const auto       touches = find_touches(scene, world, grid, reach);
    refuse_sand_in_the_way(scene, world, touches);
    const SandMap      sand(scene, world.sand);
    const auto         in_sand = shares_in_sand(world, sand);
    std::vector<Layer> layers;
    for (std::size_t table = 0; table < scene.rocks.size(); ++table)
    {
        if (!makes_room(scene, scene.rocks[table])) { continue; }
        Layer layer = find_layer(scene, table, world, in_sand);
        if (layer.sand > 0) { layers.push_back(std::move(layer)); }
    }
    if (layers.empty() && touches.empty()) { return; }
    auto       kept    = keep_all_but_rock_volume(world, touches, in_sand);
    const auto changes = push_off({world, grid, reach, sand, world.geometry.spacing}, touches, kept);
    for (const Layer& layer : layers) { world.layers.push_back(shares_of(layer, world.sand, kept)); }
    apply_changes(changes, world.sand);
}

} // namespace tread::world
