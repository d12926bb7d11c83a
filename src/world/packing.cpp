#include "world/packing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace tread::world
{
namespace
{

/// A rock seen from above.
struct Stone
{
    const shape::ShapeTemplate* form;
    Vec3<double>                centre; ///< m
    Mat3<double>                to_body;
    double                      scale;

    double reach() const { return scale * form->bounding_radius; }
    double highest() const { return centre[2] + reach(); }

    /// m, height of the rock's surface at (x, y); minus infinity if the vertical line misses it. Traces the distance
    /// field, which does not exceed the distance.
    double top(double x, double y, double above) const
    {
        const double least_step = 1e-3 * reach();
        for (double z = highest(); z > centre[2] - reach() && z > above;)
        {
            const Vec3<double> local    = to_body * (Vec3<double>(x, y, z) - centre) / scale;
            const double       distance = scale * shape::sample(form->sdf, local);
            if (distance <= 0) { return z; }
            z -= std::max(distance, least_step);
        }
        return -std::numeric_limits<double>::infinity();
    }
};

std::vector<Stone> stones(const World& world, const io::BodyFields& bodies)
{
    std::vector<Stone> found;
    const std::size_t  count = bodies.scale.size();
    for (auto b = static_cast<std::size_t>(world.bodies.named); b < count; ++b)
    {
        const double* turn = bodies.orientation.data() + 4 * b;
        found.push_back({&world.templates[static_cast<std::size_t>(bodies.shape[b])],
                         Vec3<double>(bodies.position.data() + 3 * b),
                         Quat(turn[0], turn[1], turn[2], turn[3]).conjugate().toRotationMatrix(), bodies.scale[b]});
    }
    std::sort(found.begin(), found.end(), [](const Stone& a, const Stone& b) { return a.highest() > b.highest(); });
    return found;
}

/// Columns over the plan of all rocks.
struct Columns
{
    double              low[2];
    double              edge; ///< m
    std::int64_t        count[2];
    std::vector<double> top; ///< m; 0 = the floor
};

/// Edge of the columns over the rocks' mean diameter, where there are few rocks.
constexpr double finest_columns = 1.0 / 32;

/// Largest number of columns, about. With 2e7 of them the fraction of 300,000 rocks takes 29 s, with these 1.4 s, and
/// differs by 3e-5 of itself.
constexpr double most_columns = 1e6;

Columns columns_under(const std::vector<Stone>& stones, double mean_diameter)
{
    Columns columns{};
    double  extent[2];
    for (int c = 0; c < 2; ++c)
    {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Stone& stone : stones)
        {
            low  = std::min(low, stone.centre[c] - stone.reach());
            high = std::max(high, stone.centre[c] + stone.reach());
        }
        columns.low[c] = low;
        extent[c]      = high - low;
    }
    columns.edge = std::max(finest_columns * mean_diameter, std::sqrt(extent[0] * extent[1] / most_columns));
    for (int c = 0; c < 2; ++c) { columns.count[c] = static_cast<std::int64_t>(std::ceil(extent[c] / columns.edge)); }
    columns.top.assign(static_cast<std::size_t>(columns.count[0] * columns.count[1]), 0.0);
    return columns;
}

void raise(Columns& columns, const Stone& stone)
{
    std::int64_t first[2], last[2];
    for (int c = 0; c < 2; ++c)
    {
        const double at = stone.centre[c] - columns.low[c];
        first[c]        = static_cast<std::int64_t>((at - stone.reach()) / columns.edge);
        last[c] = std::min(columns.count[c] - 1, static_cast<std::int64_t>((at + stone.reach()) / columns.edge));
    }
    for (std::int64_t j = first[1]; j <= last[1]; ++j)
    {
        for (std::int64_t i = first[0]; i <= last[0]; ++i)
        {
            double& top = columns.top[static_cast<std::size_t>(i + columns.count[0] * j)];
            if (top >= stone.highest()) { continue; }
            const double x = columns.low[0] + (static_cast<double>(i) + 0.5) * columns.edge;
            const double y = columns.low[1] + (static_cast<double>(j) + 0.5) * columns.edge;
            top            = std::max(top, stone.top(x, y, top));
        }
    }
}

} // namespace

double packing_fraction(const World& world, const io::BodyFields& bodies)
{
    const std::vector<Stone> rocks = stones(world, bodies);
    if (rocks.empty()) { return 0; }
    double solids = 0, mean_diameter = 0;
    for (const Stone& rock : rocks)
    {
        solids += rock.form->unit.volume * std::pow(rock.scale, 3);
        mean_diameter += rock.scale * volume_diameter(*rock.form) / static_cast<double>(rocks.size());
    }
    Columns columns = columns_under(rocks, mean_diameter);
    for (const Stone& rock : rocks) { raise(columns, rock); }
    const double below = std::accumulate(columns.top.begin(), columns.top.end(), 0.0) * columns.edge * columns.edge;
    return below > 0 ? solids / below : 0;
}

} // namespace tread::world
