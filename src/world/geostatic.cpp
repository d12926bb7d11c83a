#include "world/geostatic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "world/materials.hpp"

namespace tread::world
{
namespace
{

/// Mass in a column of the plan: that of a sand point, or a share of a body's.
struct Weight
{
    static constexpr std::uint32_t none = ~0U;

    std::int64_t  column;
    double        height; ///< m
    double        mass;   ///< kg
    std::uint32_t order;  ///< 0 for bodies, id + 1 for points
    std::uint32_t point;  ///< index of the point that gets the stress, or none

    /// Orders by column, then from the top down. Bodies of one height and mass may come in any order.
    bool operator<(const Weight& other) const
    {
        if (column != other.column) { return column < other.column; }
        if (height != other.height) { return height > other.height; }
        if (order != other.order) { return order < other.order; }
        return mass < other.mass;
    }
};

static_assert(sizeof(Weight) == bytes_of_weight);

/// Columns over the plan of the domain, as wide as a cell.
struct Plan
{
    double       width; ///< m
    std::int64_t columns_x;

    std::int64_t along(double x) const { return static_cast<std::int64_t>(std::floor(x / width)); }
    std::int64_t column(std::int64_t i, std::int64_t j) const { return j * columns_x + i; }
    std::int64_t column_of(const Vec3<double>& x) const { return column(along(x[0]), along(x[1])); }
};

/// Set of columns that hold given points.
class ColumnSet
{
public:
    ColumnSet(const Plan& plan, const std::vector<Vec3<double>>& positions)
    {
        std::int64_t last = std::numeric_limits<std::int64_t>::min();
        first_            = std::numeric_limits<std::int64_t>::max();
        for (const Vec3<double>& x : positions)
        {
            first_ = std::min(first_, plan.column_of(x));
            last   = std::max(last, plan.column_of(x));
        }
        if (positions.empty()) { return; }
        held_.resize(static_cast<std::size_t>(last - first_ + 1));
        for (const Vec3<double>& x : positions) { held_[static_cast<std::size_t>(plan.column_of(x) - first_)] = true; }
    }

    bool holds(std::int64_t column) const
    {
        const std::int64_t at = column - first_;
        return at >= 0 && at < static_cast<std::int64_t>(held_.size()) && held_[static_cast<std::size_t>(at)];
    }

private:
    std::int64_t      first_;
    std::vector<bool> held_;
};

/// Distributes a rock's weight over all columns that its sphere of equal volume covers.
void add_rocks(const HostBodies& bodies, const Plan& plan, const ColumnSet& columns, std::vector<Weight>& weights)
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
                const std::int64_t column = plan.column(i, j);
                if (columns.holds(column)) { weights.push_back({column, x[2], share, 0, Weight::none}); }
            }
        }
    }
}

/// Adds the sand of the columns. Points of a saved bed keep their saved stress. `points`: by ascending id.
void add_sand(const Sand& sand, const Plan& plan, const ColumnSet& columns, const HostPoints& points,
              std::vector<Weight>& weights)
{
    std::uint32_t next = 0; // of `points`
    for_each_point(sand,
                   [&](const SandPoint& point)
                   {
                       std::uint32_t index = Weight::none;
                       if (next < points.size() && points.id[next] == point.id) { index = next++; }
                       const std::int64_t column = plan.column_of(point.position);
                       const bool         rests  = sand.velocity_of(point.kind) == Vec3<double>::Zero();
                       if (!rests || !columns.holds(column)) { return; }
                       if (point.kind.saved >= 0) { index = Weight::none; }
                       weights.push_back({column, point.position[2], point.kind.mass,
                                          static_cast<std::uint32_t>(point.id) + 1, index});
                   });
}

double horizontal_stress(const scene::Material& material, double vertical)
{
    const double at_rest = material.poisson / (1 - material.poisson) * vertical;
    return scene::is_granular(material.model) ? std::max(at_rest, active_stress(material, vertical)) : at_rest;
}

std::vector<Weight> sorted_weights(const scene::Scene& scene, const HostBodies& bodies, const Sand& sand,
                                   const HostPoints& points)
{
    // A margin of two columns: a rock at a wall may extend beyond it by rounding.
    const double        width = scene.grid.spacing;
    const Plan          plan{width, static_cast<std::int64_t>(std::ceil(scene.domain.size[0] / width)) + 4};
    const ColumnSet     columns(plan, points.position);
    std::vector<Weight> weights;
    weights.reserve(points.size() + points.size() / 8 + bodies.size()); // columns at the border hold more than `points`
    add_sand(sand, plan, columns, points, weights);
    add_rocks(bodies, plan, columns, weights);
    std::sort(weights.begin(), weights.end());
    return weights;
}

} // namespace

void set_geostatic_stress(const scene::Scene& scene, const HostBodies& bodies, const Sand& sand, HostPoints& points)
{
    const double gravity = -scene.domain.gravity[2];
    if (gravity <= 0 || points.size() == 0) { return; }
    bodies.require_rocks();
    const double              area    = scene.grid.spacing * scene.grid.spacing;
    const std::vector<Weight> weights = sorted_weights(scene, bodies, sand, points);
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
            const std::size_t point = weights[at].point;
            if (point == Weight::none) { continue; }
            const double horizontal = horizontal_stress(scene.materials[points.material[point]], vertical);
            points.stress[point]    = Sym3<double>(-horizontal, -horizontal, -vertical, 0, 0, 0);
        }
        const bool same_column = end < weights.size() && weights[end].column == weights[first].column;
        above                  = same_column ? above + level : 0;
        first                  = end;
    }
}

} // namespace tread::world
