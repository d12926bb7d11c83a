#include "world/host_points.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/host_memory.hpp"
#include "world/geostatic.hpp"

namespace tread::world
{
namespace
{

bool moves(const Vec3<double>& velocity) { return velocity != Vec3<double>::Zero(); }

/// Whether the arrays that only some scenes need are filled.
struct Extras
{
    bool velocity;
    bool plastic_shear;
};

/// Calls act for each array that is filled.
template<class Act>
void for_each_array(HostPoints& points, Extras extras, const Act& act)
{
    act(points.position);
    act(points.volume);
    act(points.mass);
    act(points.stress);
    act(points.material);
    act(points.terrain);
    act(points.id);
    if (extras.velocity) { act(points.velocity); }
    if (extras.plastic_shear) { act(points.plastic_shear); }
}

void reserve(std::size_t count, Extras extras, HostPoints& points)
{
    double bytes = 0;
    for_each_array(points, extras,
                   [&](auto& values) { bytes += static_cast<double>(count) * double(sizeof(values[0])); });
    require_host_memory({bytes, fmt::format("[[terrain]]: {:.3g} points of sand", double(count)),
                         "coarsen [grid] spacing, points_per_cell or the table's spacing, or use more ranks"});
    for_each_array(points, extras, [&](auto& values) { values.reserve(count); });
}

void append(const Sand& sand, const SandPoint& point, Extras extras, HostPoints& points)
{
    const PointKind&  kind  = point.kind;
    const SavedState* saved = kind.saved < 0 ? nullptr : &sand.saved[static_cast<std::size_t>(kind.saved)];
    points.position.push_back(point.position);
    points.volume.push_back(kind.volume);
    points.mass.push_back(kind.mass);
    points.stress.push_back(saved == nullptr ? Sym3<double>::Zero() : saved->stress);
    points.material.push_back(kind.material);
    points.terrain.push_back(kind.terrain);
    points.id.push_back(static_cast<std::uint32_t>(point.id));
    if (extras.velocity) { points.velocity.push_back(sand.velocity_of(kind)); }
    if (extras.plastic_shear) { points.plastic_shear.push_back(saved == nullptr ? 0 : saved->plastic_shear); }
}

} // namespace

std::int64_t bytes_of_made_point()
{
    HostPoints  points;
    std::size_t bytes = bytes_of_weight;
    for_each_array(points, {false, false}, [&](auto& values) { bytes += sizeof(values[0]); });
    return static_cast<std::int64_t>(bytes);
}

HostPoints make_points(const scene::Scene& scene, const World& world, const std::vector<PointRow>& rows)
{
    const Sand&  sand = world.sand;
    const Extras extras{std::any_of(sand.velocity.begin(), sand.velocity.end(), moves), !sand.saved.empty()};
    std::size_t  count = 0;
    for (const PointRow& row : rows) { count += row.count; }
    HostPoints points;
    reserve(count, extras, points);
    for (const PointRow& row : rows)
    {
        for_each_point(sand, row, [&](const SandPoint& point) { append(sand, point, extras, points); });
    }
    set_geostatic_stress(scene, world.bodies, sand, points);
    return points;
}

} // namespace tread::world
