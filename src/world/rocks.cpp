#include "world/rocks.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "world/placement.hpp"

namespace tread::world
{
namespace
{

std::size_t place(const scene::Scene& scene, std::size_t table, const Space& space, const std::vector<RockDraw>& rocks,
                  World& world)
{
    switch (scene.rocks[table].placement)
    {
    case scene::Placement::grid:
        return place_on_lattice(scene, table, space, rocks, world);
    case scene::Placement::points:
        return place_at_points(scene, table, space, rocks, world);
    case scene::Placement::replace:
    case scene::Placement::rain:
        break;
    }
    return place_at_random(scene, table, space, rocks, world);
}

/// Throws when a table's rocks do not fit, with the number placed and the solid fraction.
[[noreturn]] void refuse(const scene::Scene& scene, std::size_t table, const std::vector<RockDraw>& drawn,
                         std::size_t placed)
{
    const scene::Rocks& rocks  = scene.rocks[table];
    double              solids = 0;
    for (std::size_t i = 0; i < placed; ++i) { solids += sphere_volume(drawn[i].diameter); }
    const auto requested = rocks.count ? fmt::format("count = {}", *rocks.count)
                                       : fmt::format("{} (solid_fraction = {})", drawn.size(), *rocks.solid_fraction);
    throw InputError(fmt::format(
        "[[rocks]] {} of shape '{}': only {} of {} fit without overlap into region {}, a solid "
        "fraction of {:.3f}; enlarge the region, or ask for fewer or smaller rocks",
        table, rocks.shape, placed, requested, text_of(rocks.region), solids / volume(rocks_space(scene, table))));
}

} // namespace

Space rocks_space(const scene::Scene& scene, std::size_t table)
{
    const scene::Rocks& rocks = scene.rocks[table];
    return make_space(rocks.region, rocks.height, rocks.floor, fmt::format("[[rocks]] {}", table));
}

std::vector<scene::Shape> rocks_family(const scene::Scene& scene, std::size_t table)
{
    return shape::members(shape::find_shape(scene, scene.rocks[table].shape));
}

void place_rocks(const scene::Scene& scene, std::size_t table, const std::vector<RockDraw>& rocks, World& world)
{
    const std::size_t placed = place(scene, table, rocks_space(scene, table), rocks, world);
    if (placed < rocks.size()) { refuse(scene, table, rocks, placed); }
}

} // namespace tread::world
