#include "world/bed.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "world/rocks.hpp"

namespace tread::world
{
namespace
{

std::vector<io::TerrainReport> describe_terrain(const scene::Scene& scene, const Sand& sand)
{
    std::vector<io::TerrainReport> tables(scene.terrain.size());
    for (std::size_t table = 0; table < tables.size(); ++table)
    {
        tables[table].material = scene.terrain[table].material;
    }
    for_each_point(sand,
                   [&](const SandPoint& point)
                   {
                       auto& table = tables[static_cast<std::size_t>(point.kind.terrain)];
                       ++table.points;
                       table.volume += point.kind.volume;
                       table.mass += point.kind.mass;
                   });
    return tables;
}

io::RocksReport describe_rocks(const scene::Scene& scene, std::size_t table, const HostBodies& bodies)
{
    const std::size_t first = table == 0 ? static_cast<std::size_t>(bodies.named) : bodies.rocks_end[table - 1];
    const std::size_t end   = bodies.rocks_end[table];
    io::RocksReport   report;
    report.shape             = scene.rocks[table].shape;
    report.count             = static_cast<std::int64_t>(end - first);
    report.smallest_diameter = 2 * *std::min_element(bodies.radius.begin() + static_cast<std::ptrdiff_t>(first),
                                                     bodies.radius.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t b = first; b < end; ++b)
    {
        const double diameter = 2 * bodies.radius[b];
        report.volume += sphere_volume(diameter);
        report.mass += bodies.mass[b];
        report.mean_diameter += diameter / static_cast<double>(report.count);
        report.largest_diameter = std::max(report.largest_diameter, diameter);
    }
    report.solid_fraction = report.volume / volume(rocks_space(scene, table));
    return report;
}

/// Percentage without a sign where it rounds to 0.0.
double without_sign_of_zero(double percent) { return std::abs(percent) < 0.05 ? 0 : percent; }

} // namespace

io::BedReport describe_bed(const scene::Scene& scene, const World& world)
{
    io::BedReport bed;
    bed.terrain = describe_terrain(scene, world.sand);
    for (std::size_t table = 0; table < scene.rocks.size(); ++table)
    {
        bed.rocks.push_back(describe_rocks(scene, table, world.bodies));
    }
    for (const LayerShares& layer : world.layers)
    {
        bed.layers.push_back({static_cast<std::int64_t>(layer.table), layer.sand, layer.rock, layer.empty()});
    }
    double rocks = 0, points = 0;
    for (const auto& table : bed.rocks) { rocks += table.volume; }
    for (const auto& table : bed.terrain) { points += table.volume; }
    bed.rock_share = rocks > 0 ? rocks / (rocks + points) : 0;
    return bed;
}

std::vector<std::string> bed_lines(const io::BedReport& bed)
{
    std::vector<std::string> lines;
    for (const auto& table : bed.terrain)
    {
        lines.push_back(fmt::format("terrain {} of {}: {} points, {:.6g} m3, {:.6g} kg", lines.size(), table.material,
                                    table.points, table.volume, table.mass));
    }
    for (std::size_t i = 0; i < bed.rocks.size(); ++i)
    {
        const auto& table = bed.rocks[i];
        lines.push_back(fmt::format("rocks {} of {}: {}, {:.6g} kg, solid fraction {:.4f} of their region, diameters "
                                    "{:.4g} to {:.4g} m, mean {:.4g} m",
                                    i, table.shape, table.count, table.mass, table.solid_fraction,
                                    table.smallest_diameter, table.largest_diameter, table.mean_diameter));
    }
    for (const auto& layer : bed.layers)
    {
        lines.push_back(fmt::format("layer of rocks {}: {:.1f} % sand, {:.1f} % rock, {:.1f} % void", layer.table,
                                    100 * layer.sand, 100 * layer.rock, without_sign_of_zero(100 * layer.empty)));
    }
    if (bed.rock_share > 0 && !bed.terrain.empty())
    {
        lines.push_back(fmt::format("rocks are {:.4f} of the volume of rocks and points", bed.rock_share));
    }
    return lines;
}

} // namespace tread::world
