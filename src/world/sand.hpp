#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "backend/vector.hpp"

// The sand of a scene as rows of equally spaced points. Rows are few beside points (1e6 for a bed of 1e9), so that
// every rank has the whole bed, and allocates only the points of its own pages (host_points.hpp).
namespace tread::world
{

/// Properties shared by the points of a row.
struct PointKind
{
    double       volume;        ///< m3
    double       mass;          ///< kg
    std::int32_t terrain  = 0;  ///< index of the [[terrain]] table that created the points
    std::int32_t saved    = -1; ///< index into Sand::saved; -1 = not from a saved bed
    std::uint8_t material = 0;  ///< index into Scene::materials
};

/// State of a point in a saved bed.
struct SavedState
{
    Sym3<double> stress; ///< Pa
    double       plastic_shear;
};

/// Points at origin + spacing (site + k + 0.5) along x, 0 <= k < count.
struct PointRow
{
    double        origin;  ///< m
    double        spacing; ///< m; 0 for a single point at the origin
    double        y, z;    ///< m
    std::int64_t  site;
    std::uint32_t count;
    std::int32_t  kind;      ///< index into Sand::kinds
    std::uint32_t first = 0; ///< id of the first point; set by append

    Vec3<double> at(std::uint32_t k) const { return {origin + spacing * (static_cast<double>(site + k) + 0.5), y, z}; }
};

struct Sand
{
    std::vector<PointRow>     rows; ///< by ascending id
    std::vector<PointKind>    kinds;
    std::vector<SavedState>   saved;
    std::vector<Vec3<double>> velocity; ///< m/s, of each [[terrain]] table at the start

    /// Number of points. Their ids are 0 to size() - 1.
    std::size_t size() const { return rows.empty() ? 0 : std::size_t{rows.back().first} + rows.back().count; }

    const PointKind&    kind_of(const PointRow& row) const { return kinds[static_cast<std::size_t>(row.kind)]; }
    const Vec3<double>& velocity_of(const PointKind& kind) const
    {
        return velocity[static_cast<std::size_t>(kind.terrain)];
    }
};

/// The points from <= k < to of a row.
inline PointRow part_of(PointRow row, std::uint32_t from, std::uint32_t to)
{
    row.site += from;
    row.first += from;
    row.count = to - from;
    return row;
}

/// A row of one point.
inline PointRow alone_at(const Vec3<double>& x, std::int32_t kind) { return {x[0], 0, x[1], x[2], 0, 1, kind}; }

/// Appends a row, with the next free ids.
void append(Sand& sand, PointRow row);

/// Calls act(part) for each run of a row's points for which kept(k) is true; kept is called once for each, in order.
template<class Kept, class Act>
void for_each_part(const PointRow& row, const Kept& kept, const Act& act)
{
    for (std::uint32_t from = 0; from < row.count;)
    {
        std::uint32_t to = from;
        while (to < row.count && kept(to)) { ++to; }
        if (to > from) { act(part_of(row, from, to)); }
        from = to + 1;
    }
}

/// Appends the points of a row for which kept(k) is true.
template<class Kept>
void append_where(Sand& sand, const PointRow& row, const Kept& kept)
{
    for_each_part(row, kept, [&](const PointRow& part) { append(sand, part); });
}

/// A point, while it is visited.
struct SandPoint
{
    std::size_t      id;
    Vec3<double>     position; ///< m
    const PointKind& kind;
};

/// Calls act(SandPoint) for the points of a row.
template<class Act>
void for_each_point(const Sand& sand, const PointRow& row, const Act& act)
{
    const PointKind& kind = sand.kind_of(row);
    for (std::uint32_t k = 0; k < row.count; ++k) { act(SandPoint{std::size_t{row.first} + k, row.at(k), kind}); }
}

/// Calls act(SandPoint) for all points, by ascending id.
template<class Act>
void for_each_point(const Sand& sand, const Act& act)
{
    for (const PointRow& row : sand.rows) { for_each_point(sand, row, act); }
}

/// The point with an id, by bisection.
SandPoint point_of(const Sand& sand, std::size_t id);

/// A point that is moved to a place, or removed if there is none.
struct PointChange
{
    std::size_t                 id;
    std::optional<Vec3<double>> place; ///< m
};

/// Applies changes, given by ascending id; then numbers the points anew in their order.
void apply_changes(const std::vector<PointChange>& changes, Sand& sand);

/// Bytes of the description, which every rank has.
std::int64_t bytes_of(const Sand& sand);

double total_mass(const Sand& sand);     ///< kg
double least_mass(const Sand& sand);     ///< kg; infinite without points
double largest_volume(const Sand& sand); ///< m3; 0 without points

} // namespace tread::world
