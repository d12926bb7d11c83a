#include "world/terrain_bins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "base/host_memory.hpp"
#include "scene/lines.hpp"

namespace tread::world
{
namespace
{

constexpr double none = std::numeric_limits<double>::quiet_NaN();

constexpr double full_enough = 0.3; ///< solid fraction: half of a loose bed of rocks; scattered points are far below
constexpr int    dense_bins  = 4;   ///< bins averaged for the packing density of a column

/// Solid fraction of bins, 0 beyond the ends.
class Fractions
{
public:
    Fractions(std::int64_t first, const std::vector<double>& volume, double of_bin)
        : first_(first)
        , volume_(volume)
        , of_bin_(of_bin)
    {
    }

    std::int64_t first() const { return first_; }
    std::int64_t end() const { return first_ + static_cast<std::int64_t>(volume_.size()); }

    double operator[](std::int64_t bin) const
    {
        return bin < first() || bin >= end() ? 0 : volume_[static_cast<std::size_t>(bin - first_)] / of_bin_;
    }

    double sum(std::int64_t from, std::int64_t to) const
    {
        double sum = 0;
        for (std::int64_t bin = from; bin < to; ++bin) { sum += (*this)[bin]; }
        return sum;
    }

private:
    std::int64_t               first_;
    const std::vector<double>& volume_;
    double                     of_bin_;
};

/// Top of a column's bed, in bins, and the solid volume near it.
struct Top
{
    std::int64_t          reference = 0; ///< bin from whose bottom the surface is computed
    double                content   = 0; ///< solid volume, in bins, from there up to `counted`
    double                counted   = 0; ///< top of the highest bin that is counted
    double                fog       = 0; ///< solid fraction of floating material
    std::optional<double> packing;       ///< solid fraction below the reference; empty where the bed is too thin
};

std::optional<Top> top_of(const Fractions& fraction, std::int64_t slope_bins)
{
    std::int64_t top = fraction.end() - 1, bottom = fraction.first();
    while (top >= fraction.first() && fraction[top] < full_enough) { --top; }
    if (top < fraction.first()) { return {}; }
    while (fraction[bottom] < full_enough) { ++bottom; }

    // The bed's floor may lie within the lowest bin.
    const std::int64_t under = std::max<std::int64_t>(top - bottom - 1, 0);
    const std::int64_t slope = std::min(slope_bins, under / 2);
    const std::int64_t dense = std::min(std::max<std::int64_t>(dense_bins, slope_bins), under - slope);

    Top found{top - slope, fraction.sum(top - slope, top + 2), static_cast<double>(top + 2),
              0.5 * fraction.sum(top + 2, top + 4), std::nullopt};
    if (dense > 0)
    {
        found.packing =
            std::max(fraction.sum(top - slope - dense, top - slope) / static_cast<double>(dense), full_enough);
    }
    return found;
}

/// Height of the surface, in bins.
double surface_of(const Top& top, double packing)
{
    const double fog = std::min(top.fog, 0.5 * packing), base = static_cast<double>(top.reference);
    return base + (top.content - fog * (top.counted - base)) / (packing - fog);
}

/// Median over the columns with a known packing; 1 without any.
double median_packing(const std::vector<std::optional<Top>>& tops)
{
    std::vector<double> known;
    for (const auto& top : tops)
    {
        if (top && top->packing) { known.push_back(*top->packing); }
    }
    if (known.empty()) { return 1; }
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), middle, known.end());
    return *middle;
}

std::int64_t bin_of(double place, double width) { return static_cast<std::int64_t>(std::floor(place / width)); }

double overlap(double low, double high, std::int64_t bin, double width)
{
    const double from = width * static_cast<double>(bin);
    return std::min(high, from + width) - std::max(low, from);
}

} // namespace

ColumnLattice column_lattice(const scene::Scene& scene, const World& world)
{
    const auto   named = static_cast<std::size_t>(world.bodies.named), rocks = world.bodies.size() - named;
    const double spacing = scene.terrain.empty() ? 0 : scene.grid.spacing;
    double       mean    = 0;
    for (std::size_t b = named; b < world.bodies.size(); ++b)
    {
        mean += 2 * world.bodies.radius[b] / static_cast<double>(rocks);
    }
    ColumnLattice lattice;
    const double  width = std::max(spacing, 2 * mean);
    if (width <= 0) { return lattice; }
    for (std::size_t c = 0; c < 2; ++c)
    {
        lattice.count[c] = std::max<std::int64_t>(1, std::lround(scene.domain.size[c] / width));
        lattice.width[c] = scene.domain.size[c] / static_cast<double>(lattice.count[c]);
    }
    lattice.bin = std::max(spacing, 0.5 * mean);
    return lattice;
}

void require_room_for_columns(const scene::Scene& scene, const World& world)
{
    constexpr double    of_column = 64; // bytes of the bins and heights of an empty column
    const ColumnLattice lattice   = column_lattice(scene, world);
    const double        columns   = static_cast<double>(lattice.count[0]) * static_cast<double>(lattice.count[1]);
    scene::with_line_of(scene, "grid",
                        [&]
                        {
                            require_host_memory({of_column * columns,
                                                 fmt::format("[grid] spacing: {:.3g} columns of the domain", columns),
                                                 "a coarser spacing or a smaller [domain] size"});
                        });
}

TerrainBins::TerrainBins(const ColumnLattice& lattice)
    : lattice_(lattice)
    , columns_(static_cast<std::size_t>(lattice.size()))
{
}

void TerrainBins::add_block(const Vec3<double>& centre, double edge, double volume)
{
    if (columns_.empty() || !centre.allFinite()) { return; }
    const double                half = 0.5 * edge;
    std::array<std::int64_t, 2> first{}, last{};
    for (std::size_t c = 0; c < 2; ++c)
    {
        const double place = centre[static_cast<Eigen::Index>(c)];
        first[c] = std::clamp<std::int64_t>(bin_of(place - half, lattice_.width[c]), 0, lattice_.count[c] - 1);
        last[c]  = std::clamp<std::int64_t>(bin_of(place + half, lattice_.width[c]), 0, lattice_.count[c] - 1);
    }
    // Volume beyond the outermost columns counts as theirs: they extend to infinity.
    const auto share = [&](std::size_t c, std::int64_t at)
    {
        const double inf = std::numeric_limits<double>::infinity(), from = lattice_.width[c] * static_cast<double>(at);
        const double place = centre[static_cast<Eigen::Index>(c)];
        const double low = at == 0 ? -inf : from, high = at == lattice_.count[c] - 1 ? inf : from + lattice_.width[c];
        return std::max(0.0, std::min(place + half, high) - std::max(place - half, low)) / edge;
    };
    for (std::int64_t j = first[1]; j <= last[1]; ++j)
    {
        const double along_y = share(1, j);
        for (std::int64_t i = first[0]; i <= last[0]; ++i)
        {
            const double part = along_y * share(0, i) * volume;
            if (part <= 0) { continue; }
            add_to_column(columns_[static_cast<std::size_t>(i + lattice_.count[0] * j)], centre[2] - half,
                          centre[2] + half, part);
        }
    }
}

void TerrainBins::add_to_column(Column& column, double low, double high, double volume) const
{
    const std::int64_t first = bin_of(low, lattice_.bin), last = bin_of(high, lattice_.bin);
    if (column.volume.empty()) { column.first = first; }
    if (first < column.first)
    {
        column.volume.insert(column.volume.begin(), static_cast<std::size_t>(column.first - first), 0.0);
        column.first = first;
    }
    const auto needed = static_cast<std::size_t>(last - column.first + 1);
    if (column.volume.size() < needed) { column.volume.resize(needed, 0.0); }
    for (std::int64_t bin = first; bin <= last; ++bin)
    {
        const double part = std::max(0.0, overlap(low, high, bin, lattice_.bin)) / (high - low);
        column.volume[static_cast<std::size_t>(bin - column.first)] += part * volume;
    }
}

void TerrainBins::add_sphere(const Vec3<double>& centre, double radius)
{
    // The ball as those of its box's 4 x 4 x 4 cubes whose centres lie inside: 32.
    constexpr int    samples = 32;
    constexpr double sphere  = 4.0 / 3.0 * std::numbers::pi;
    const double     volume  = sphere * radius * radius * radius / samples;
    for (const double x : {-0.75, -0.25, 0.25, 0.75})
    {
        for (const double y : {-0.75, -0.25, 0.25, 0.75})
        {
            for (const double z : {-0.75, -0.25, 0.25, 0.75})
            {
                const Vec3<double> place(x, y, z);
                if (place.norm() < 1) { add_block(centre + radius * place, 0.5 * radius, volume); }
            }
        }
    }
}

void TerrainBins::add_ranks(const Communicator& communicator)
{
    // Rows: column, lowest bin, number of bins, their volumes.
    std::vector<double> rows;
    for (std::size_t c = 0; c < columns_.size(); ++c)
    {
        const Column& column = columns_[c];
        if (column.volume.empty()) { continue; }
        rows.insert(rows.end(), {static_cast<double>(c), static_cast<double>(column.first),
                                 static_cast<double>(column.volume.size())});
        rows.insert(rows.end(), column.volume.begin(), column.volume.end());
    }
    rows = communicator.gather(rows);
    columns_.assign(columns_.size(), {});
    for (std::size_t at = 0; at < rows.size();)
    {
        Column&    column = columns_[static_cast<std::size_t>(rows[at])];
        const auto first  = static_cast<std::int64_t>(rows[at + 1]);
        const auto count  = static_cast<std::size_t>(rows[at + 2]);
        at += 3;
        for (std::size_t i = 0; i < count; ++i, ++at)
        {
            const double middle = (static_cast<double>(first) + static_cast<double>(i) + 0.5) * lattice_.bin;
            add_to_column(column, middle - 0.25 * lattice_.bin, middle + 0.25 * lattice_.bin, rows[at]);
        }
    }
}

std::vector<double> TerrainBins::surface() const
{
    const auto slope_bins =
        static_cast<std::int64_t>(std::ceil(std::max(lattice_.width[0], lattice_.width[1]) / lattice_.bin - 1e-9));
    std::vector<std::optional<Top>> tops;
    tops.reserve(columns_.size());
    for (const Column& column : columns_)
    {
        tops.push_back(top_of(Fractions(column.first, column.volume, area() * lattice_.bin), slope_bins));
    }
    const double        typical = median_packing(tops);
    std::vector<double> heights;
    heights.reserve(tops.size());
    for (const auto& top : tops)
    {
        heights.push_back(top ? lattice_.bin * surface_of(*top, top->packing.value_or(typical)) : none);
    }
    return heights;
}

} // namespace tread::world
