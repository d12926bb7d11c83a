#include "world/sand.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace tread::world
{
void append(Sand& sand, PointRow row)
{
    row.first = static_cast<std::uint32_t>(sand.size());
    sand.rows.push_back(row);
}

SandPoint point_of(const Sand& sand, std::size_t id)
{
    const auto      after = std::upper_bound(sand.rows.begin(), sand.rows.end(), id,
                                             [](std::size_t i, const PointRow& row) { return i < row.first; });
    const PointRow& row   = *std::prev(after);
    return {id, row.at(static_cast<std::uint32_t>(id - row.first)), sand.kind_of(row)};
}

void apply_changes(const std::vector<PointChange>& changes, Sand& sand)
{
    const std::vector<PointRow> before = std::exchange(sand.rows, {});
    auto                        next   = changes.begin();
    for (const PointRow& row : before)
    {
        std::uint32_t from = 0;
        for (; next != changes.end() && next->id - row.first < row.count; ++next)
        {
            const auto at = static_cast<std::uint32_t>(next->id - row.first);
            if (at > from) { append(sand, part_of(row, from, at)); }
            if (next->place) { append(sand, alone_at(*next->place, row.kind)); }
            from = at + 1;
        }
        if (from < row.count) { append(sand, part_of(row, from, row.count)); }
    }
}

std::int64_t bytes_of(const Sand& sand)
{
    return static_cast<std::int64_t>(sand.rows.size() * sizeof(PointRow) + sand.kinds.size() * sizeof(PointKind) +
                                     sand.saved.size() * sizeof(SavedState));
}

/// The sum runs over points, not rows: its rounding does not depend on how the points lie in rows.
double total_mass(const Sand& sand)
{
    double sum = 0;
    for (const PointRow& row : sand.rows)
    {
        for (std::uint32_t k = 0; k < row.count; ++k) { sum += sand.kind_of(row).mass; }
    }
    return sum;
}

double least_mass(const Sand& sand)
{
    double least = std::numeric_limits<double>::infinity();
    for (const PointRow& row : sand.rows) { least = std::min(least, sand.kind_of(row).mass); }
    return least;
}

double largest_volume(const Sand& sand)
{
    double largest = 0;
    for (const PointRow& row : sand.rows) { largest = std::max(largest, sand.kind_of(row).volume); }
    return largest;
}

} // namespace tread::world
