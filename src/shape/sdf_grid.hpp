#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "shape/template.hpp"

// Building and measuring signed distance grids.
namespace tread::shape
{

/// The nodes over 120 % of `box` about its middle, `cells` cubic cells along the longest axis, values still to be set.
/// Every axis has at least one cell beyond the box, and beyond `reach` (m) outside it, at each end: that adds cells
/// where 10 % of the box is less. Throws InputError unless 8 <= cells <= 1024.
SignedDistanceGrid grid_over(const Bounds& box, int cells, double reach = 0);

/// m3, where the interpolant is negative: exact along x, by 4 x 4 lines a cell in y and z.
double enclosed_volume(const SignedDistanceGrid& sdf);

inline Eigen::Vector3d node_position(const SignedDistanceGrid& sdf, std::int32_t i, std::int32_t j, std::int32_t k)
{
    return sdf.origin + sdf.spacing * Eigen::Vector3d(i, j, k);
}

inline std::size_t node_index(const SignedDistanceGrid& sdf, std::int32_t i, std::int32_t j, std::int32_t k)
{
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(sdf.nodes[0]) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(sdf.nodes[1]) * static_cast<std::size_t>(k));
}

/// Samples a signed distance at every node, rows in parallel. `distance(point, within)` returns metres, negative
/// inside; `within` is an upper bound of its magnitude, known from the node before because a distance is 1-Lipschitz.
template<class Distance>
SignedDistanceGrid build_sdf(const Bounds& box, int cells, const Distance& distance, double reach = 0)
{
    SignedDistanceGrid sdf = grid_over(box, cells, reach);
    // A little over the spacing: the bound must survive rounding.
    const double step = 1.001 * sdf.spacing;
#pragma omp parallel for collapse(2) schedule(dynamic, 4)
    for (std::int32_t k = 0; k < sdf.nodes[2]; ++k)
    {
        for (std::int32_t j = 0; j < sdf.nodes[1]; ++j)
        {
            double within = std::numeric_limits<double>::infinity();
            for (std::int32_t i = 0; i < sdf.nodes[0]; ++i)
            {
                const double value                   = distance(node_position(sdf, i, j, k), within);
                sdf.values[node_index(sdf, i, j, k)] = static_cast<float>(value);
                within                               = std::abs(value) + step;
            }
        }
    }
    return sdf;
}

} // namespace tread::shape
