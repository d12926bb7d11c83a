#include "world/geostatic.hpp"

#include <algorithm>
#include <cmath>

#include "world/materials.hpp"

namespace tread::world
{
namespace
{

/// Mass in a column of the plan: that of a sand point, or a share of a body's.
struct Weight
{
    static constexpr std::int64_t no_point = -1;

    std::int64_t column;
    double       height; ///< m
    double       mass;   ///< kg
    std::int64_t point;

    /// Orders by column, then from the top down.
    bool operator<(const Weight& other) const
    {
        if (column != other.column) { return column < other.column; }
        if (height != other.height) { return height > other.height; }
        return point < other.point;
    }
};

/// Columns over the plan of the domain, as wide as a cell.
struct Plan
{
    double       width; ///< m
    std::int64_t columns_x;

    std::int64_t along(double x) const { return static_cast<std::int64_t>(std::floor(x / width)); }
    std::int64_t column(std::int64_t i, std::int64_t j) const { return j * columns_x + i; }
};

/// Distributes a rock's weight over all columns that its sphere of equal volume covers.
void add_rocks(const HostBodies& bodies, const Plan& plan, std::vector<Weight>& weights)
{
    for (auto b = static_cast<std::size_t>(bodies.named); b < bodies.size(); ++b)
    {
        const Vec3<double> x      = bodies.position[b];
        const double       radius = bodies.radius[b];
        const std::int64_t low_i = plan.along(x[0] - radius), high_i = plan.along(x[0] + radius),
                           low_j = plan.along(x[1] - radius), high_j = plan.along(x[1] + radius);
        const double share = bodies.mass[b] / double((high_i - low_i + 1) * (high_j - low_j + 1));
        for (std::int64_t j = low_j; j <= high_j; ++j)
        {
            for (std::int64_t i = low_i; i <= high_i; ++i)
            {
                weights.push_back({plan.column(i, j), x[2], share, Weight::no_point});
            }
        }
    }
}

double horizontal_stress(const scene::Material& material, double vertical)
{
    const double at_rest = material.poisson / (1 - material.poisson) * vertical;
    return scene::is_granular(material.model) ? std::max(at_rest, active_stress(material, vertical)) : at_rest;
}

bool rests(const HostPoints& points, std::size_t i)
{
    return points.velocity.empty() || points.velocity[i] == Vec3<double>::Zero();
}

/// Points of a saved bed have their saved stress.
bool has_stress(const scene::Scene& scene, const HostPoints& points, std::size_t i)
{
    return !scene.terrain[static_cast<std::size_t>(points.terrain[i])].from.empty();
}

std::vector<Weight> sorted_weights(const scene::Scene& scene, const HostBodies& bodies, const HostPoints& points)
{
    // A margin of two columns: a rock at a wall may extend beyond it by rounding.
    const double        width = scene.grid.spacing;
    const Plan          plan{width, static_cast<std::int64_t>(std::ceil(scene.domain.size[0] / width)) + 4};
    std::vector<Weight> weights;
    weights.reserve(points.size() + bodies.size());
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        if (!rests(points, i)) { continue; }
        const Vec3<double>& x = points.position[i];
        weights.push_back(
            {plan.column(plan.along(x[0]), plan.along(x[1])), x[2], points.mass[i], static_cast<std::int64_t>(i)});
    }
    add_rocks(bodies, plan, weights);
    std::sort(weights.begin(), weights.end());
    return weights;
}

} // namespace

void set_geostatic_stress(const scene::Scene& scene, const HostBodies& bodies, HostPoints& points)
{
    const double gravity = -scene.domain.gravity[2];
    if (gravity <= 0 || points.size() == 0) { return; }
    const double              area    = scene.grid.spacing * scene.grid.spacing;
    const std::vector<Weight> weights = sorted_weights(scene, bodies, points);
    double                    above   = 0;
    for (std::size_t first = 0; first < weights.size();)
    {
        // Masses at the same height of a column: at their centres, half of each is above.
        std::size_t end   = first;
        double      level = 0;
        for (; end < weights.size() && weights[end].column == weights[first].column &&
               weights[end].height == weights[first].height;
             ++end)
        {
            level += weights[end].mass;
        }
        const double vertical = (above + 0.5 * level) * gravity / area;
        for (std::size_t at = first; at < end; ++at)
        {
            if (weights[at].point == Weight::no_point) { continue; }
            const auto point = static_cast<std::size_t>(weights[at].point);
            if (has_stress(scene, points, point)) { continue; }
            const double horizontal = horizontal_stress(scene.materials[points.material[point]], vertical);
            points.stress[point]    = Sym3<double>(-horizontal, -horizontal, -vertical, 0, 0, 0);
        }
        const bool same_column = end < weights.size() && weights[end].column == weights[first].column;
        above                  = same_column ? above + level : 0;
        first                  = end;
    }
}

} // namespace tread::world
