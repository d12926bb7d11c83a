#include "solver/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

namespace tread::solver
{
namespace
{

bool inside(const scene::Box& box, const Vec3<double>& x)
{
    for (std::size_t c = 0; c < 3; ++c)
    {
        const auto k = static_cast<Eigen::Index>(c);
        if (x[k] < box.low[c] || x[k] >= box.high[c]) { return false; }
    }
    return true;
}

double lattice_spacing(const scene::Scene& scene, const scene::Terrain& terrain)
{
    return scene.grid.spacing / std::round(std::cbrt(terrain.points_per_cell));
}

void append(HostPoints& points, const Vec3<double>& x, double volume, double density, std::uint8_t material)
{
    points.position.push_back(x);
    points.volume.push_back(volume);
    points.mass.push_back(density * volume);
    points.stress.push_back(Sym3<double>::Zero());
    points.material.push_back(material);
}

void remove_inside(HostPoints& points, const scene::Box& box)
{
    HostPoints kept;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        if (inside(box, points.position[i])) { continue; }
        append(kept, points.position[i], points.volume[i], points.mass[i] / points.volume[i], points.material[i]);
    }
    points = std::move(kept);
}

void add_box(const scene::Scene& scene, const scene::Terrain& terrain, HostPoints& points)
{
    remove_inside(points, terrain.region);
    const double spacing  = lattice_spacing(scene, terrain);
    const int    material = material_index(scene, terrain.material);
    const double density  = scene.materials[static_cast<std::size_t>(material)].density;
    const auto   first    = [&](std::size_t c)
    { return static_cast<long>(std::ceil(terrain.region.low[c] / spacing - 0.5 - 1e-9)); };
    const auto end = [&](std::size_t c)
    { return static_cast<long>(std::ceil(terrain.region.high[c] / spacing - 0.5 - 1e-9)); };
    for (long k = first(2); k < end(2); ++k)
    {
        for (long j = first(1); j < end(1); ++j)
        {
            for (long i = first(0); i < end(0); ++i)
            {
                const Vec3<double> lattice(double(i) + 0.5, double(j) + 0.5, double(k) + 0.5);
                append(points, spacing * lattice, spacing * spacing * spacing, density,
                       static_cast<std::uint8_t>(material));
            }
        }
    }
}

/// Weights standing in one column of the plan, by height.
struct Column
{
    std::vector<std::pair<double, double>> height_and_mass;
    std::vector<std::size_t>               points;
};

using Plan = std::map<std::pair<long, long>, Column>;

std::pair<long, long> column_of(double x, double y, double width)
{
    return {static_cast<long>(std::floor(x / width)), static_cast<long>(std::floor(y / width))};
}

/// A rock's weight rests on all columns that its sphere of equal volume covers.
void add_rock_weights(const HostBodies& bodies, double width, Plan& plan)
{
    for (std::size_t b = static_cast<std::size_t>(bodies.named); b < bodies.size(); ++b)
    {
        const Vec3<double> x       = bodies.position[b];
        const double       radius  = bodies.radius[b];
        const auto         low     = column_of(x[0] - radius, x[1] - radius, width);
        const auto         high    = column_of(x[0] + radius, x[1] + radius, width);
        const double       columns = double((high.first - low.first + 1) * (high.second - low.second + 1));
        for (long i = low.first; i <= high.first; ++i)
        {
            for (long j = low.second; j <= high.second; ++j)
            {
                plan[{i, j}].height_and_mass.emplace_back(x[2], bodies.mass[b] / columns);
            }
        }
    }
}

double horizontal_stress(const scene::Material& material, double vertical)
{
    const double at_rest = material.poisson / (1 - material.poisson) * vertical;
    if (material.model != scene::MaterialModel::mohr_coulomb) { return at_rest; }
    const double sine   = std::sin(material.friction_angle_deg * std::numbers::pi / 180);
    const double active = (1 - sine) / (1 + sine);
    return std::max(at_rest, active * vertical - 2 * material.cohesion * std::sqrt(active));
}

} // namespace

HostPoints make_terrain(const scene::Scene& scene)
{
    HostPoints points;
    for (const scene::Terrain& terrain : scene.terrain) { add_box(scene, terrain, points); }
    return points;
}

double terrain_spacing(const scene::Scene& scene)
{
    double smallest = 0;
    for (const scene::Terrain& terrain : scene.terrain)
    {
        const double spacing = lattice_spacing(scene, terrain);
        smallest             = smallest == 0 ? spacing : std::min(smallest, spacing);
    }
    return smallest;
}

void set_geostatic_stress(const scene::Scene& scene, const HostBodies& bodies, HostPoints& points)
{
    const double width   = scene.grid.spacing;
    const double gravity = -scene.domain.gravity[2];
    if (gravity <= 0) { return; }
    Plan plan;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        Column& column = plan[column_of(points.position[i][0], points.position[i][1], width)];
        column.points.push_back(i);
        column.height_and_mass.emplace_back(points.position[i][2], points.mass[i]);
    }
    add_rock_weights(bodies, width, plan);
    for (auto& [place, column] : plan)
    {
        std::sort(column.height_and_mass.begin(), column.height_and_mass.end(), std::greater<>());
        std::sort(column.points.begin(), column.points.end(),
                  [&](std::size_t a, std::size_t b) { return points.position[a][2] > points.position[b][2]; });
        double      above = 0;
        std::size_t next  = 0;
        for (std::size_t at = 0; at < column.points.size();)
        {
            const double height = points.position[column.points[at]][2];
            while (next < column.height_and_mass.size() && column.height_and_mass[next].first > height)
            {
                above += column.height_and_mass[next++].second;
            }
            double level = 0; // masses at this very height: their centres are here, so half of each is above
            while (next < column.height_and_mass.size() && column.height_and_mass[next].first >= height)
            {
                level += column.height_and_mass[next++].second;
            }
            const double vertical = (above + 0.5 * level) * gravity / (width * width);
            above += level;
            for (; at < column.points.size() && points.position[column.points[at]][2] >= height; ++at)
            {
                const std::size_t point      = column.points[at];
                const double      horizontal = horizontal_stress(scene.materials[points.material[point]], vertical);
                points.stress[point]         = Sym3<double>(-horizontal, -horizontal, -vertical, 0, 0, 0);
            }
        }
    }
}

} // namespace tread::solver
