#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "shape/template.hpp"

// Construction and quality of signed distance grids.
namespace tread::shape
{

/// Grid nodes over 120 % of `box` about its middle, with `cells` cubic cells along the longest axis; values are not
/// set. Every axis has at least one cell beyond the box, and beyond `reach` (m) outside it, at each end: cells are
/// added where 10 % of the box is less. Throws InputError unless 8 <= cells <= 1024.
SignedDistanceGrid grid_over(const Bounds& box, int cells, double reach = 0);

/// Volume (m3) where the interpolant is negative: exact along x, by 4 x 4 lines per cell in y and z.
double enclosed_volume(const SignedDistanceGrid& sdf);

/// Largest |gradient| of the interpolant outside the surface and nearer than fine_reach; at least 1.
double steepest_slope(const SignedDistanceGrid& sdf);

inline Eigen::Vector3d node_position(const SignedDistanceGrid& sdf, std::int32_t i, std::int32_t j, std::int32_t k)
{
    return sdf.origin + sdf.spacing * Eigen::Vector3d(i, j, k);
}

/// Index into the values of a dense grid.
inline std::size_t node_index(const SignedDistanceGrid& sdf, std::int32_t i, std::int32_t j, std::int32_t k)
{
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(sdf.nodes[0]) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(sdf.nodes[1]) * static_cast<std::size_t>(k));
}

/// Signed distance in metres, negative inside; `within`: an upper bound of its magnitude, derived from another node
/// because a distance is 1-Lipschitz. Must be thread-safe.
using SignedDistance = std::function<double(const Eigen::Vector3d& point, double within)>;

/// Largest number of nodes of a dense grid (4 MiB). Above it, bricks are read equally fast and built faster.
inline constexpr std::size_t most_dense_nodes = std::size_t{1} << 20;

/// Storage layout of a grid.
enum class Storage
{
    by_size, ///< dense up to most_dense_nodes
    dense,
    bricks
};

/// Samples a signed distance on grid_over(box, cells, reach). In brick storage, bricks with any point nearer to the
/// surface than `reach` and four cells are fine. EnvironmentError if the grid does not fit into memory.
SignedDistanceGrid build_sdf(const Bounds& box, int cells, const SignedDistance& distance, double reach = 0,
                             Storage storage = Storage::by_size);

/// Volume (m3) that enclosed_volume would give with that many cells; stores no grid.
double enclosed_volume_with(const Bounds& box, int cells, const SignedDistance& distance);

/// Fraction of a cell in which the trilinear interpolant of its eight corners, x fastest, is negative.
double cell_inside(const std::array<double, 8>& corners);

} // namespace tread::shape
