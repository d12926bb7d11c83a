#include <algorithm>
#include <array>
#include <cmath>

#include "shape/distance/sdf_grid.hpp"

namespace tread::shape
{
namespace
{

/// A block of nodes, x fastest; those nearer to the surface than `reach` (m) are exact.
struct NodeBlock
{
    const float*               values;
    std::array<std::size_t, 3> nodes;
    double                     reach;
};

/// Square of the largest |gradient| of a cell's interpolant, times the spacing: it is at a corner, because the square
/// is convex along each axis. 0 for a cell inside the surface or beyond the reach.
double steepest_of_cell(const float* low, std::size_t row, std::size_t layer, double reach)
{
    const auto at = [&](std::size_t i, std::size_t j, std::size_t k)
    { return static_cast<double>(low[i + j * row + k * layer]); };
    double largest = 0, highest = at(0, 0, 0), lowest = highest;
    for (std::size_t k = 0; k < 2; ++k)
    {
        for (std::size_t j = 0; j < 2; ++j)
        {
            for (std::size_t i = 0; i < 2; ++i)
            {
                highest        = std::max(highest, at(i, j, k));
                lowest         = std::min(lowest, at(i, j, k));
                const double x = at(1, j, k) - at(0, j, k), y = at(i, 1, k) - at(i, 0, k),
                             z = at(i, j, 1) - at(i, j, 0);
                largest        = std::max(largest, x * x + y * y + z * z);
            }
        }
    }
    return highest > 0 && lowest < reach ? largest : 0.0;
}

double steepest_of_block(const NodeBlock& block)
{
    const std::size_t row = block.nodes[0], layer = row * block.nodes[1];
    double            largest = 0;
    for (std::size_t k = 0; k + 1 < block.nodes[2]; ++k)
    {
        for (std::size_t j = 0; j + 1 < block.nodes[1]; ++j)
        {
            for (std::size_t i = 0; i + 1 < block.nodes[0]; ++i)
            {
                const float* low = block.values + i + j * row + k * layer;
                largest          = std::max(largest, steepest_of_cell(low, row, layer, block.reach));
            }
        }
    }
    return largest;
}

} // namespace

double steepest_slope(const SignedDistanceGrid& sdf)
{
    std::array<std::size_t, 3> nodes{};
    std::copy(sdf.nodes.begin(), sdf.nodes.end(), nodes.begin());
    if (!sdf.slots.empty()) { nodes.fill(SignedDistanceGrid::brick_nodes); }
    const std::size_t size    = nodes[0] * nodes[1] * nodes[2];
    const std::size_t blocks  = sdf.values.size() / size;
    double            largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest)
    for (std::size_t b = 0; b < blocks; ++b)
    {
        largest = std::max(largest, steepest_of_block({sdf.values.data() + b * size, nodes, sdf.fine_reach}));
    }
    return std::max(1.0, std::sqrt(largest) / sdf.spacing);
}

} // namespace tread::shape
