#include "world/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/host_memory.hpp"
#include "scene/lines.hpp"
#include "world/refinement.hpp"
#include "world/region.hpp"
#include "world/saved_sand.hpp"

namespace tread::world
{
namespace
{

/// Sites (first + i + 0.5) * spacing + origin, i from 0 to count, along one axis.
struct Sites
{
    double origin;
    double spacing;
    long   first;
    long   end;

    double at(long i) const { return origin + spacing * (double(i) + 0.5); }
};

/// Sites inside [low, high), with a tolerance for rounding.
Sites sites_between(double low, double high, double spacing, double origin)
{
    const auto index = [&](double at) { return static_cast<long>(std::ceil((at - origin) / spacing - 0.5 - 1e-9)); };
    return {origin, spacing, index(low), index(high)};
}

/// Lattice of a table's points, restricted to the box `within`.
std::array<Sites, 3> lattice(const scene::Terrain& terrain, double spacing, const scene::Box& within)
{
    const auto           box = bounds(terrain.region);
    std::array<Sites, 3> axes{};
    for (std::size_t c = 0; c < 3; ++c)
    {
        axes[c] = sites_between(std::max(box.low[c], within.low[c]), std::min(box.high[c], within.high[c]), spacing,
                                terrain.spacing ? box.low[c] : 0.0);
    }
    return axes;
}

bool moves(const scene::Terrain& terrain) { return terrain.velocity != scene::Vector3{}; }

/// Properties that a table gives each of its points.
struct PointKind
{
    double       volume;
    double       mass;
    std::uint8_t material;
    std::int32_t table;
};

void append(HostPoints& points, const Vec3<double>& x, const PointKind& kind)
{
    points.position.push_back(x);
    points.volume.push_back(kind.volume);
    points.mass.push_back(kind.mass);
    points.stress.push_back(Sym3<double>::Zero());
    points.material.push_back(kind.material);
    points.terrain.push_back(kind.table);
    if (!points.plastic_shear.empty()) { points.plastic_shear.push_back(0); }
}

void remove_inside(HostPoints& points, const Space& space)
{
    std::vector<std::uint8_t> kept(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) { kept[i] = contains(space, points.position[i]) ? 0 : 1; }
    keep_points(points, kept);
}

/// Throws if there are more points than 32-bit lists can index.
void require_countable(const HostPoints& points)
{
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    if (points.size() > most)
    {
        throw InputError(fmt::format("[[terrain]]: over {} points; accepted: at most that many on one device; coarsen "
                                     "[grid] spacing or points_per_cell",
                                     most));
    }
}

std::size_t count(const Sites& sites) { return static_cast<std::size_t>(std::max(0L, sites.end - sites.first)); }

/// Throws EnvironmentError where a table's columns or points do not fit into memory. Points are estimated from the
/// space's volume, since its bounding box may be mostly empty.
void require_room_for_points(const Space& space, const std::array<Sites, 3>& axes, const std::string& owner)
{
    constexpr double of_column = sizeof(std::pair<double, double>), growth = 2; // reallocation of a growing vector
    constexpr double of_point = growth * (sizeof(Vec3<double>) + sizeof(Sym3<double>) + 2 * sizeof(double) +
                                          sizeof(std::uint8_t) + sizeof(std::int32_t));
    const char*      advice   = "coarsen [grid] spacing, points_per_cell or the table's spacing";
    const double     columns  = static_cast<double>(count(axes[0])) * static_cast<double>(count(axes[1]));
    const double     sites    = columns * static_cast<double>(count(axes[2]));
    require_host_memory({of_column * columns, fmt::format("{}: its {:.3g} columns of points", owner, columns), advice});
    if (of_column * columns + of_point * sites < 0.1 * static_cast<double>(available_host_memory())) { return; }
    const double points = std::min(sites, volume(space) / std::pow(axes[0].spacing, 3));
    require_host_memory({of_column * columns + of_point * points,
                         fmt::format("{}: its {:.3g} points, {:.3g} m apart,", owner, points, axes[0].spacing),
                         advice});
}

/// Sites along z between the lowest and the highest level of all columns.
Sites sites_of_levels(Sites along_z, const std::vector<std::pair<double, double>>& level)
{
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (const auto& [low, high] : level)
    {
        lowest  = std::min(lowest, low);
        highest = std::max(highest, high);
    }
    if (level.empty()) { return along_z; }
    const double bottom = along_z.at(along_z.first - 1), top = along_z.at(along_z.end);
    const Sites  between = sites_between(std::clamp(lowest, bottom, top), std::clamp(highest, bottom, top),
                                         along_z.spacing, along_z.origin);
    along_z.first        = std::max(along_z.first, between.first - 1);
    along_z.end          = std::min(along_z.end, between.end + 1);
    return along_z;
}

/// Adds a point at each site in the space for which `wanted` is true.
template<class Wanted>
void fill(const Space& space, const std::array<Sites, 3>& axes, const PointKind& kind, const Wanted& wanted,
          HostPoints& points)
{
    // Points are added layer by layer; levels are computed once per column.
    const auto& [along_x, along_y, all_along_z] = axes;
    const std::size_t columns_x = count(along_x), columns_y = count(along_y);

    std::vector<std::pair<double, double>> level(columns_x * columns_y);
    for (std::size_t j = 0; j < columns_y; ++j)
    {
        for (std::size_t i = 0; i < columns_x; ++i)
        {
            level[j * columns_x + i] = levels(space, along_x.at(along_x.first + static_cast<long>(i)),
                                              along_y.at(along_y.first + static_cast<long>(j)));
        }
    }
    const Sites along_z = sites_of_levels(all_along_z, level);
    for (long k = along_z.first; k < along_z.end; ++k)
    {
        for (std::size_t column = 0; column < level.size(); ++column)
        {
            const Vec3<double> x(along_x.at(along_x.first + static_cast<long>(column % columns_x)),
                                 along_y.at(along_y.first + static_cast<long>(column / columns_x)), along_z.at(k));
            const auto& [low, high] = level[column];
            if (low <= x[2] && x[2] < high && contains(space.region, x) && wanted(x)) { append(points, x, kind); }
        }
        require_countable(points);
    }
}

PointKind kind_of(const scene::Scene& scene, std::size_t table, double spacing)
{
    const int    material = material_index(scene, scene.terrain[table].material);
    const double volume   = spacing * spacing * spacing;
    return {volume, scene.materials[static_cast<std::size_t>(material)].density * volume,
            static_cast<std::uint8_t>(material), static_cast<std::int32_t>(table)};
}

/// Adds the points in one level of the grid, on the lattice of its cells.
void fill_level(const scene::Scene& scene, std::size_t table, const Space& space, const mpm::Refinement& refinement,
                int level, HostPoints& points)
{
    const scene::Terrain& terrain = scene.terrain[table];
    const double          spacing = lattice_spacing(scene, terrain) / (1 << level);
    const scene::Box      within  = level == 0 ? bounds(terrain.region) : box_of(scene, refinement, level);
    const auto            here    = [&](const Vec3<double>& x) { return level_at(scene, refinement, x) == level; };
    const auto            sites   = lattice(terrain, spacing, within);
    require_room_for_points(space, sites, fmt::format("[[terrain]] {}", table));
    fill(space, sites, kind_of(scene, table, spacing), here, points);
}

void add_table(const scene::Scene& scene, std::size_t table, const mpm::Refinement& refinement, HostPoints& points)
{
    const scene::Terrain& terrain = scene.terrain[table];
    if (!terrain.from.empty())
    {
        append_saved_points(scene, table, points);
        return;
    }
    const auto  owner = fmt::format("[[terrain]] {}", table);
    const Space space = make_space(terrain.region, terrain.height, terrain.floor, owner);
    remove_inside(points, space);
    const double spacing = lattice_spacing(scene, terrain);
    const auto   before  = points.size();
    if (refinement.levels == 0 || terrain.spacing)
    {
        const auto anywhere = [](const Vec3<double>&) { return true; };
        const auto sites    = lattice(terrain, spacing, bounds(terrain.region));
        require_room_for_points(space, sites, owner);
        fill(space, sites, kind_of(scene, table, spacing), anywhere, points);
    }
    else
    {
        for (int level = 0; level <= refinement.levels; ++level)
        {
            fill_level(scene, table, space, refinement, level, points);
        }
    }
    if (points.size() == before)
    {
        throw InputError(fmt::format("{}: no point of its lattice (spacing {:.4g} m) lies in its region {} between "
                                     "floor and height; enlarge them, or refine the grid",
                                     owner, spacing, text_of(terrain.region)));
    }
}

void set_velocities(const scene::Scene& scene, HostPoints& points)
{
    if (std::none_of(scene.terrain.begin(), scene.terrain.end(), moves)) { return; }
    points.velocity.reserve(points.size());
    for (const std::int32_t table : points.terrain)
    {
        points.velocity.emplace_back(scene.terrain[static_cast<std::size_t>(table)].velocity.data());
    }
}

} // namespace

HostPoints make_terrain(const scene::Scene& scene, const mpm::Refinement& refinement)
{
    HostPoints points;
    for (std::size_t table = 0; table < scene.terrain.size(); ++table)
    {
        scene::with_line_of(scene, fmt::format("terrain[{}]", table),
                            [&] { add_table(scene, table, refinement, points); });
    }
    set_velocities(scene, points);
    return points;
}

double lattice_spacing(const scene::Scene& scene, const scene::Terrain& terrain)
{
    return terrain.spacing.value_or(scene.grid.spacing / std::round(std::cbrt(terrain.points_per_cell)));
}

double terrain_spacing(const scene::Scene& scene, const HostPoints& points)
{
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const bool on_scene_lattice = scene.grid.refine.empty();
        if (on_scene_lattice && scene.terrain[static_cast<std::size_t>(points.terrain[i])].from.empty()) { continue; }
        smallest = std::min(smallest, std::cbrt(points.volume[i]));
    }
    for (const scene::Terrain& terrain : scene.terrain)
    {
        if (terrain.from.empty()) { smallest = std::min(smallest, lattice_spacing(scene, terrain)); }
    }
    return std::isinf(smallest) ? 0 : smallest;
}

std::int64_t keep_points(HostPoints& points, const std::vector<std::uint8_t>& kept)
{
    const std::size_t before  = points.size();
    const auto        compact = [&](auto& values)
    {
        if (values.empty()) { return; }
        std::size_t end = 0;
        for (std::size_t i = 0; i < before; ++i)
        {
            if (kept[i] != 0) { values[end++] = values[i]; }
        }
        values.resize(end);
    };
    compact(points.volume);
    compact(points.mass);
    compact(points.stress);
    compact(points.material);
    compact(points.terrain);
    compact(points.velocity);
    compact(points.plastic_shear);
    compact(points.id);
    compact(points.position);
    return static_cast<std::int64_t>(before - points.size());
}

} // namespace tread::world
