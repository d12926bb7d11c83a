#include "shape/sdf_grid.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"

namespace tread::shape
{
namespace
{

/// The eight values of a cell, x fastest.
using Corners = std::array<double, 8>;

Corners cell_corners(const SignedDistanceGrid& sdf, const std::array<std::int32_t, 3>& cell)
{
    Corners values;
    for (std::int32_t c = 0; c < 8; ++c)
    {
        values[static_cast<std::size_t>(c)] =
            sdf.values[node_index(sdf, cell[0] + (c & 1), cell[1] + ((c >> 1) & 1), cell[2] + (c >> 2))];
    }
    return values;
}

double mix(double at_zero, double at_one, double fraction) { return at_zero + fraction * (at_one - at_zero); }

/// A place of the grid: the point of the box nearest to the one asked for.
struct Place
{
    Eigen::Vector3d point; ///< in the box
    Corners         corners;
    Eigen::Vector3d fraction; ///< in the cell, 0..1
};

Place locate(const SignedDistanceGrid& sdf, const Eigen::Vector3d& point)
{
    Place                       place;
    std::array<std::int32_t, 3> cell{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto   a        = static_cast<Eigen::Index>(axis);
        const int    cells    = sdf.nodes[axis] - 1;
        const double in_cells = std::clamp((point[a] - sdf.origin[a]) / sdf.spacing, 0.0, static_cast<double>(cells));
        cell[axis]            = std::min(static_cast<std::int32_t>(in_cells), cells - 1);
        place.fraction[a]     = in_cells - cell[axis];
        const double high     = sdf.origin[a] + sdf.spacing * cells;
        place.point[a]        = std::clamp(point[a], sdf.origin[a], high);
    }
    place.corners = cell_corners(sdf, cell);
    return place;
}

double interpolate(const Place& place)
{
    const Corners& v   = place.corners;
    const auto&    f   = place.fraction;
    const double   low = mix(mix(v[0], v[1], f.x()), mix(v[2], v[3], f.x()), f.y());
    const double   top = mix(mix(v[4], v[5], f.x()), mix(v[6], v[7], f.x()), f.y());
    return mix(low, top, f.z());
}

Eigen::Vector3d interpolate_gradient(const Place& place, double spacing)
{
    const Corners& v = place.corners;
    const auto&    f = place.fraction;
    const double   x = mix(mix(v[1] - v[0], v[3] - v[2], f.y()), mix(v[5] - v[4], v[7] - v[6], f.y()), f.z());
    const double   y = mix(mix(v[2] - v[0], v[3] - v[1], f.x()), mix(v[6] - v[4], v[7] - v[5], f.x()), f.z());
    const double   z = mix(mix(v[4] - v[0], v[5] - v[1], f.x()), mix(v[6] - v[2], v[7] - v[3], f.x()), f.y());
    return Eigen::Vector3d(x, y, z) / spacing;
}

/// Part of a line from value a to value b along which their linear interpolant is negative.
double negative_part(double a, double b)
{
    if (a < 0 && b < 0) { return 1; }
    if (a >= 0 && b >= 0) { return 0; }
    return std::min(a, b) / (std::min(a, b) - std::max(a, b));
}

/// Part of a cell in which the interpolant is negative.
double negative_part(const Corners& v)
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

double slab_volume(const SignedDistanceGrid& sdf, std::int32_t k)
{
    double cells = 0;
    for (std::int32_t j = 0; j + 1 < sdf.nodes[1]; ++j)
    {
        for (std::int32_t i = 0; i + 1 < sdf.nodes[0]; ++i) { cells += negative_part(cell_corners(sdf, {i, j, k})); }
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
    std::size_t           count  = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto   a      = static_cast<Eigen::Index>(axis);
        const double length = std::max(1.2 * box.extent()[a], box.extent()[a] + 2 * (reach + sdf.spacing));
        // 120 % of the longest axis is a whole number of cells but for rounding, which must not add one.
        const auto across = static_cast<std::int32_t>(std::ceil(length / sdf.spacing - 1e-6));
        sdf.nodes[axis]   = across + 1;
        sdf.origin[a]     = middle[a] - 0.5 * sdf.spacing * across;
        count *= static_cast<std::size_t>(sdf.nodes[axis]);
    }
    sdf.values.resize(count);
    return sdf;
}

double enclosed_volume(const SignedDistanceGrid& sdf)
{
    const std::int32_t  slabs = sdf.nodes[2] - 1;
    std::vector<double> parts(static_cast<std::size_t>(slabs));
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int32_t k = 0; k < slabs; ++k) { parts[static_cast<std::size_t>(k)] = slab_volume(sdf, k); }
    double cells = 0;
    for (const double part : parts) { cells += part; }
    return cells * sdf.spacing * sdf.spacing * sdf.spacing;
}

// Outside the box, the surface lies within it: the way to the surface turns by at least a right angle at the nearest
// point of the box, so the two legs' root of squares is a lower bound of the distance, continuous at the box.
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
    Eigen::Vector3d       gradient = interpolate_gradient(place, sdf.spacing);
    if (leg.isZero(0)) { return gradient; }
    const double          value = std::max(interpolate(place), 0.0);
    const Eigen::Vector3d along = (leg.array() == 0).select(gradient, 0.0);
    return (leg + value * along) / std::hypot(leg.norm(), value);
}

} // namespace tread::shape
