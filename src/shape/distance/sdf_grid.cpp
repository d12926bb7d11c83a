#include "shape/distance/sdf_grid.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"

namespace tread::shape
{
namespace
{

/// Values at the eight corners of a cell, x fastest.
using CellCorners = std::array<double, 8>;

/// Values in memory; corners of a cell are `row` and `layer` apart along y and z.
struct Block
{
    const float* first;
    std::size_t  row;
    std::size_t  layer;

    CellCorners corners(std::size_t i, std::size_t j, std::size_t k) const
    {
        const float* low = first + i + row * j + layer * k;
        const float* top = low + layer;
        return {low[0], low[1], low[row], low[row + 1], top[0], top[1], top[row], top[row + 1]};
    }
};

constexpr std::size_t brick_edge = SignedDistanceGrid::brick_cells;

using NodeIndex = std::array<std::size_t, 3>;

bool in_bricks(const SignedDistanceGrid& sdf) { return !sdf.slots.empty(); }

std::size_t at(const std::array<std::int32_t, 3>& counts, std::size_t more, const NodeIndex& i)
{
    const std::size_t row = static_cast<std::size_t>(counts[0]) + more;
    return i[0] + row * (i[1] + (static_cast<std::size_t>(counts[1]) + more) * i[2]);
}

Block dense_block(const SignedDistanceGrid& sdf)
{
    const auto row = static_cast<std::size_t>(sdf.nodes[0]);
    return {sdf.values.data(), row, row * static_cast<std::size_t>(sdf.nodes[1])};
}

Block fine_block(const SignedDistanceGrid& sdf, std::int32_t slot)
{
    constexpr std::size_t n = SignedDistanceGrid::brick_nodes;
    return {sdf.values.data() + n * n * n * static_cast<std::size_t>(slot), n, n * n};
}

Block coarse_block(const SignedDistanceGrid& sdf)
{
    const auto row = static_cast<std::size_t>(sdf.bricks[0]) + 1;
    return {sdf.corners.data(), row, row * (static_cast<std::size_t>(sdf.bricks[1]) + 1)};
}

double mix(double at_zero, double at_one, double fraction) { return at_zero + fraction * (at_one - at_zero); }

/// A position in the grid: the point of the box nearest to a query point.
struct Place
{
    Eigen::Vector3d point; ///< in the box
    CellCorners     corners;
    Eigen::Vector3d fraction; ///< position in the cell, 0..1
    double          spacing;  ///< m, edge of the cell
};

/// Corners and fraction of `place` in the brick that holds fine cell `cell`.
void locate_in_brick(const SignedDistanceGrid& sdf, const NodeIndex& cell, Place& place)
{
    const NodeIndex    brick{cell[0] / brick_edge, cell[1] / brick_edge, cell[2] / brick_edge};
    const NodeIndex    inner{cell[0] % brick_edge, cell[1] % brick_edge, cell[2] % brick_edge};
    const std::int32_t slot = sdf.slots[at(sdf.bricks, 0, brick)];
    if (slot >= 0)
    {
        place.corners = fine_block(sdf, slot).corners(inner[0], inner[1], inner[2]);
        return;
    }
    place.corners = coarse_block(sdf).corners(brick[0], brick[1], brick[2]);
    place.spacing = brick_edge * sdf.spacing;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        double& fraction = place.fraction[static_cast<Eigen::Index>(axis)];
        fraction         = (fraction + static_cast<double>(inner[axis])) / brick_edge;
    }
}

Place locate(const SignedDistanceGrid& sdf, const Eigen::Vector3d& point)
{
    Place     place;
    NodeIndex cell{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto   a        = static_cast<Eigen::Index>(axis);
        const int    cells    = sdf.nodes[axis] - 1;
        const double in_cells = std::clamp((point[a] - sdf.origin[a]) / sdf.spacing, 0.0, static_cast<double>(cells));
        const int    low      = std::min(static_cast<int>(in_cells), cells - 1);
        cell[axis]            = static_cast<std::size_t>(low);
        place.fraction[a]     = in_cells - low;
        const double high     = sdf.origin[a] + sdf.spacing * cells;
        place.point[a]        = std::clamp(point[a], sdf.origin[a], high);
    }
    place.spacing = sdf.spacing;
    if (in_bricks(sdf)) { locate_in_brick(sdf, cell, place); }
    else { place.corners = dense_block(sdf).corners(cell[0], cell[1], cell[2]); }
    return place;
}

double interpolate(const Place& place)
{
    const CellCorners& v   = place.corners;
    const auto&        f   = place.fraction;
    const double       low = mix(mix(v[0], v[1], f.x()), mix(v[2], v[3], f.x()), f.y());
    const double       top = mix(mix(v[4], v[5], f.x()), mix(v[6], v[7], f.x()), f.y());
    return mix(low, top, f.z());
}

Eigen::Vector3d interpolate_gradient(const Place& place)
{
    const CellCorners& v = place.corners;
    const auto&        f = place.fraction;
    const double       x = mix(mix(v[1] - v[0], v[3] - v[2], f.y()), mix(v[5] - v[4], v[7] - v[6], f.y()), f.z());
    const double       y = mix(mix(v[2] - v[0], v[3] - v[1], f.x()), mix(v[6] - v[4], v[7] - v[5], f.x()), f.z());
    const double       z = mix(mix(v[4] - v[0], v[5] - v[1], f.x()), mix(v[6] - v[2], v[7] - v[3], f.x()), f.y());
    return Eigen::Vector3d(x, y, z) / place.spacing;
}

/// Part of a line from value a to value b along which their linear interpolant is negative.
double negative_part(double a, double b)
{
    if (a < 0 && b < 0) { return 1; }
    if (a >= 0 && b >= 0) { return 0; }
    return std::min(a, b) / (std::min(a, b) - std::max(a, b));
}

/// Negative volume, in cells, of the first `counts` cells of a block.
double negative_cells(const Block& block, const NodeIndex& counts)
{
    double cells = 0;
    for (std::size_t k = 0; k < counts[2]; ++k)
    {
        for (std::size_t j = 0; j < counts[1]; ++j)
        {
            for (std::size_t i = 0; i < counts[0]; ++i) { cells += cell_inside(block.corners(i, j, k)); }
        }
    }
    return cells;
}

/// Negative volume, in cells, of a slab of a dense grid, one cell thick.
double dense_slab(const SignedDistanceGrid& sdf, std::size_t k)
{
    Block block = dense_block(sdf);
    block.first += k * block.layer;
    return negative_cells(block,
                          {static_cast<std::size_t>(sdf.nodes[0] - 1), static_cast<std::size_t>(sdf.nodes[1] - 1), 1});
}

/// Negative volume, in cells, of a slab one brick thick. Beyond the box everything is positive.
double brick_slab(const SignedDistanceGrid& sdf, std::size_t k)
{
    double cells = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(sdf.bricks[1]); ++j)
    {
        for (std::size_t i = 0; i < static_cast<std::size_t>(sdf.bricks[0]); ++i)
        {
            const std::int32_t slot = sdf.slots[at(sdf.bricks, 0, {i, j, k})];
            if (slot >= 0) { cells += negative_cells(fine_block(sdf, slot), {brick_edge, brick_edge, brick_edge}); }
            else if (coarse_block(sdf).corners(i, j, k)[0] < 0) { cells += brick_edge * brick_edge * brick_edge; }
        }
    }
    return cells;
}

} // namespace

SignedDistanceGrid grid_over(const Bounds& box, int cells, double reach)
{
    constexpr int least = 8, most = 1024;
    if (cells < least || cells > most)
    {
        throw InputError(fmt::format("sdf_cells = {}: accepted are {} to {}", cells, least, most));
    }
    SignedDistanceGrid sdf;
    sdf.spacing                  = 1.2 * box.extent().maxCoeff() / cells;
    const Eigen::Vector3d middle = 0.5 * (box.low + box.high);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto   a      = static_cast<Eigen::Index>(axis);
        const double length = std::max(1.2 * box.extent()[a], box.extent()[a] + 2 * (reach + sdf.spacing));
        // 120 % of the longest axis is a whole number of cells up to rounding, which must not add one.
        const auto across = static_cast<std::int32_t>(std::ceil(length / sdf.spacing - 1e-6));
        sdf.nodes[axis]   = across + 1;
        sdf.origin[a]     = middle[a] - 0.5 * sdf.spacing * across;
    }
    return sdf;
}

double cell_inside(const CellCorners& v)
{
    const auto [least, most] = std::minmax_element(v.begin(), v.end());
    if (*most < 0) { return 1; }
    if (*least >= 0) { return 0; }
    constexpr int lines = 4;
    double        sum   = 0;
    for (int j = 0; j < lines; ++j)
    {
        for (int k = 0; k < lines; ++k)
        {
            const double y = (j + 0.5) / lines, z = (k + 0.5) / lines;
            sum += negative_part(mix(mix(v[0], v[2], y), mix(v[4], v[6], y), z),
                                 mix(mix(v[1], v[3], y), mix(v[5], v[7], y), z));
        }
    }
    return sum / (lines * lines);
}

double enclosed_volume(const SignedDistanceGrid& sdf)
{
    const auto          slabs = static_cast<std::size_t>(in_bricks(sdf) ? sdf.bricks[2] : sdf.nodes[2] - 1);
    std::vector<double> parts(slabs);
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t k = 0; k < slabs; ++k) { parts[k] = in_bricks(sdf) ? brick_slab(sdf, k) : dense_slab(sdf, k); }
    double cells = 0;
    for (const double part : parts) { cells += part; }
    return cells * sdf.spacing * sdf.spacing * sdf.spacing;
}

// The surface lies within the box. From outside, the path to it bends by at least a right angle at the box's nearest
// point, so the root of the sum of squares of its two parts is a lower bound of the distance, continuous at the box.
double sample(const SignedDistanceGrid& sdf, const Eigen::Vector3d& point)
{
    const Place           place = locate(sdf, point);
    const Eigen::Vector3d leg   = point - place.point;
    const double          value = interpolate(place);
    if (leg.isZero(0)) { return value; }
    return std::hypot(leg.norm(), std::max(value, 0.0));
}

Eigen::Vector3d sample_gradient(const SignedDistanceGrid& sdf, const Eigen::Vector3d& point)
{
    const Place           place    = locate(sdf, point);
    const Eigen::Vector3d leg      = point - place.point;
    Eigen::Vector3d       gradient = interpolate_gradient(place);
    if (leg.isZero(0)) { return gradient; }
    const double          value = std::max(interpolate(place), 0.0);
    const Eigen::Vector3d along = (leg.array() == 0).select(gradient, 0.0);
    return (leg + value * along) / std::hypot(leg.norm(), value);
}

} // namespace tread::shape
