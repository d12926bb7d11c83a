#include "world/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

void remove_inside(Sand& sand, const Space& space)
{
    const scene::Box            box    = bounds(space.region);
    const std::vector<PointRow> before = std::exchange(sand.rows, {});
    for (const PointRow& row : before)
    {
        const bool beside = row.y < box.low[1] || row.y > box.high[1] || row.z < box.low[2] || row.z > box.high[2];
        append_where(sand, row, [&](std::uint32_t k) { return beside || !contains(space, row.at(k)); });
    }
}

/// Most points that 32-bit lists can index.
constexpr double most_points = std::numeric_limits<std::int32_t>::max();

[[noreturn]] void refuse_count(double points)
{
    throw InputError(fmt::format("[[terrain]]: {:.3g} points; accepted: at most {:.0f}; coarsen [grid] spacing, "
                                 "points_per_cell or the table's spacing",
                                 points, most_points));
}

std::size_t count(const Sites& sites) { return static_cast<std::size_t>(std::max(0L, sites.end - sites.first)); }

/// Throws where a table's columns and rows do not fit into memory, or its points into 32-bit lists. Points are
/// estimated from the space's volume, since its bounding box may be mostly empty.
void require_room(const Space& space, const std::array<Sites, 3>& axes, const std::string& owner)
{
    constexpr double of_column = sizeof(std::pair<double, double>), of_row = 2 * sizeof(PointRow), slack = 1.1;
    const char*      advice   = "coarsen [grid] spacing, points_per_cell or the table's spacing";
    const double     across   = std::max(1.0, static_cast<double>(count(axes[0])));
    const double     columns  = across * static_cast<double>(count(axes[1]));
    const double     all_rows = static_cast<double>(count(axes[1])) * static_cast<double>(count(axes[2]));
    require_host_memory({of_column * columns, fmt::format("{}: its {:.3g} columns of points", owner, columns), advice});
    const bool few = of_row * all_rows < 0.1 * static_cast<double>(available_host_memory());
    if (few && across * all_rows < most_points) { return; }
    const double points = std::min(across * all_rows, volume(space) / std::pow(axes[0].spacing, 3));
    if (points > slack * most_points) { refuse_count(points); }
    require_host_memory({of_column * columns + of_row * points / across,
                         fmt::format("{}: its {:.3g} rows of points", owner, points / across), advice});
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
void fill(const Space& space, const std::array<Sites, 3>& axes, std::int32_t kind, const Wanted& wanted, Sand& sand)
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
        for (std::size_t j = 0; j < columns_y; ++j)
        {
            const PointRow row{along_x.origin,
                               along_x.spacing,
                               along_y.at(along_y.first + static_cast<long>(j)),
                               along_z.at(k),
                               along_x.first,
                               static_cast<std::uint32_t>(columns_x),
                               kind};
            append_where(sand, row,
                         [&](std::uint32_t i)
                         {
                             const auto& [low, high] = level[j * columns_x + i];
                             if (!(low <= row.z && row.z < high)) { return false; }
                             const Vec3<double> x = row.at(i);
                             return contains(space.region, x) && wanted(x);
                         });
        }
        if (static_cast<double>(sand.size()) > most_points) { refuse_count(static_cast<double>(sand.size())); }
    }
}

/// Adds the kind of a table's points; returns its index.
std::int32_t add_kind(const scene::Scene& scene, std::size_t table, double spacing, Sand& sand)
{
    const int    material = material_index(scene, scene.terrain[table].material);
    const double volume   = spacing * spacing * spacing;
    sand.kinds.push_back({volume, scene.materials[static_cast<std::size_t>(material)].density * volume,
                          static_cast<std::int32_t>(table), -1, static_cast<std::uint8_t>(material)});
    return static_cast<std::int32_t>(sand.kinds.size()) - 1;
}

/// Adds the points in one level of the grid, on the lattice of its cells.
void fill_level(const scene::Scene& scene, std::size_t table, const Space& space, const mpm::Refinement& refinement,
                int level, Sand& sand)
{
    const scene::Terrain& terrain = scene.terrain[table];
    const double          spacing = lattice_spacing(scene, terrain) / (1 << level);
    const scene::Box      within  = level == 0 ? bounds(terrain.region) : box_of(scene, refinement, level);
    const auto            here    = [&](const Vec3<double>& x) { return level_at(scene, refinement, x) == level; };
    const auto            sites   = lattice(terrain, spacing, within);
    require_room(space, sites, fmt::format("[[terrain]] {}", table));
    fill(space, sites, add_kind(scene, table, spacing, sand), here, sand);
}

void add_table(const scene::Scene& scene, std::size_t table, const mpm::Refinement& refinement, Sand& sand)
{
    const scene::Terrain& terrain = scene.terrain[table];
    if (!terrain.from.empty())
    {
        append_saved_points(scene, table, sand);
        return;
    }
    const auto  owner = fmt::format("[[terrain]] {}", table);
    const Space space = make_space(terrain.region, terrain.height, terrain.floor, owner);
    remove_inside(sand, space);
    const double spacing = lattice_spacing(scene, terrain);
    const auto   before  = sand.size();
    if (refinement.levels == 0 || terrain.spacing)
    {
        const auto anywhere = [](const Vec3<double>&) { return true; };
        const auto sites    = lattice(terrain, spacing, bounds(terrain.region));
        require_room(space, sites, owner);
        fill(space, sites, add_kind(scene, table, spacing, sand), anywhere, sand);
    }
    else
    {
        for (int level = 0; level <= refinement.levels; ++level)
        {
            fill_level(scene, table, space, refinement, level, sand);
        }
    }
    if (sand.size() == before)
    {
        throw InputError(fmt::format("{}: no point of its lattice (spacing {:.4g} m) lies in its region {} between "
                                     "floor and height; enlarge them, or refine the grid",
                                     owner, spacing, text_of(terrain.region)));
    }
}

} // namespace

Sand make_terrain(const scene::Scene& scene, const mpm::Refinement& refinement)
{
    Sand sand;
    for (const scene::Terrain& terrain : scene.terrain) { sand.velocity.emplace_back(terrain.velocity.data()); }
    for (std::size_t table = 0; table < scene.terrain.size(); ++table)
    {
        scene::with_line_of(scene, fmt::format("terrain[{}]", table),
                            [&] { add_table(scene, table, refinement, sand); });
    }
    return sand;
}

double lattice_spacing(const scene::Scene& scene, const scene::Terrain& terrain)
{
    return terrain.spacing.value_or(scene.grid.spacing / std::round(std::cbrt(terrain.points_per_cell)));
}

double terrain_spacing(const scene::Scene& scene, const Sand& sand)
{
    double smallest = std::numeric_limits<double>::infinity();
    for (const PointRow& row : sand.rows)
    {
        const PointKind& kind             = sand.kind_of(row);
        const bool       on_scene_lattice = scene.grid.refine.empty() && kind.saved < 0;
        if (!on_scene_lattice) { smallest = std::min(smallest, std::cbrt(kind.volume)); }
    }
    for (const scene::Terrain& terrain : scene.terrain)
    {
        if (terrain.from.empty()) { smallest = std::min(smallest, lattice_spacing(scene, terrain)); }
    }
    return std::isinf(smallest) ? 0 : smallest;
}

} // namespace tread::world
