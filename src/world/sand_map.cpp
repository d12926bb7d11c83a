#include "world/sand_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/host_memory.hpp"

namespace tread::world
{
namespace
{

/// Points of a saved bed are disordered: on a lattice of their own spacing many sites would be empty.
constexpr double widening_of_disorder = 1.5;

} // namespace

SandMap::SandMap(const scene::Scene& scene, const Sand& sand)
    : tables_(scene.terrain.size())
{
    constexpr double          far = std::numeric_limits<double>::infinity();
    std::vector<Vec3<double>> low(tables_.size(), Vec3<double>::Constant(far)), high(tables_.size(), -low[0]);
    for (const PointRow& row : sand.rows)
    {
        const PointKind& kind  = sand.kind_of(row);
        const auto       table = static_cast<std::size_t>(kind.terrain);
        Sites&           sites = tables_[table];
        low[table]             = low[table].cwiseMin(row.at(0));
        high[table]            = high[table].cwiseMax(row.at(row.count - 1));
        sites.spacing          = std::max(sites.spacing, std::cbrt(kind.volume));
    }
    for (std::size_t table = 0; table < tables_.size(); ++table)
    {
        Sites& sites = tables_[table];
        if (!(sites.spacing > 0)) { continue; }
        if (!scene.terrain[table].from.empty()) { sites.spacing *= widening_of_disorder; }
        sites.low = low[table].array() - 0.5 * sites.spacing;
        for (int c = 0; c < 3; ++c)
        {
            sites.size[static_cast<std::size_t>(c)] =
                static_cast<std::int64_t>(std::floor((high[table][c] - sites.low[c]) / sites.spacing)) + 1;
        }
        const double all = double(sites.size[0]) * double(sites.size[1]) * double(sites.size[2]);
        require_host_memory({all / 8, fmt::format("[[terrain]] {}: the {:.3g} sites of its lattice", table, all),
                             "coarsen its points, or several tables of smaller regions"});
        sites.taken.resize(static_cast<std::size_t>(sites.size[0] * sites.size[1] * sites.size[2]));
    }
    for_each_point(sand,
                   [&](const SandPoint& point)
                   {
                       Sites& sites = tables_[static_cast<std::size_t>(point.kind.terrain)];
                       sites.taken[static_cast<std::size_t>(site(sites, point.position))] = true;
                   });
}

/// Index of the site; -1 outside the lattice.
std::int64_t SandMap::site(const Sites& sites, const Vec3<double>& x)
{
    std::array<std::int64_t, 3> at{};
    for (std::size_t c = 0; c < 3; ++c)
    {
        const auto axis = static_cast<Eigen::Index>(c);
        at[c]           = static_cast<std::int64_t>(std::floor((x[axis] - sites.low[axis]) / sites.spacing));
        if (at[c] < 0 || at[c] >= sites.size[c]) { return -1; }
    }
    return (at[2] * sites.size[1] + at[1]) * sites.size[0] + at[0];
}

bool SandMap::holds(std::int32_t table, const Vec3<double>& x) const
{
    const Sites& sites = tables_[static_cast<std::size_t>(table)];
    if (!(sites.spacing > 0)) { return false; }
    const std::int64_t at = site(sites, x);
    return at >= 0 && sites.taken[static_cast<std::size_t>(at)];
}

bool SandMap::holds(const Vec3<double>& x) const
{
    for (std::size_t table = 0; table < tables_.size(); ++table)
    {
        if (holds(static_cast<std::int32_t>(table), x)) { return true; }
    }
    return false;
}

} // namespace tread::world
