#include "world/reached_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "world/body_grid.hpp"

namespace tread::world
{
namespace
{

/// Largest number of cells for each body, 8 bytes, and where bodies are few.
constexpr double cells_a_body = 64;
constexpr double most_for_few = 1e6;

/// Enlarges a radius, so that no rounding hides a body from a point at its very edge.
constexpr double rounding = 1 + 1e-9;

double reached(const World& world, std::size_t body, double reach)
{
    return rounding * (bounding_radius(world, body) + reach);
}

} // namespace

ReachedCells::ReachedCells(const World& world, double reach)
{
    const std::size_t count = world.bodies.size();
    if (count == 0) { return; }
    constexpr double far = std::numeric_limits<double>::infinity();
    Vec3<double>     low = Vec3<double>::Constant(far), high = -low;
    double           width = 0; // m, of a cell: the mean of what a body reaches across
    for (std::size_t body = 0; body < count; ++body)
    {
        const double radius = reached(world, body, reach);
        low                 = low.cwiseMin(world.bodies.position[body] - Vec3<double>::Constant(radius));
        high                = high.cwiseMax(world.bodies.position[body] + Vec3<double>::Constant(radius));
        width += 2 * radius / static_cast<double>(count);
    }
    const double most = std::max(most_for_few, cells_a_body * static_cast<double>(count));
    while (((high - low) / width).array().ceil().prod() > most) { width *= 1.25; }
    low_      = low;
    per_cell_ = 1 / width;
    for (std::size_t c = 0; c < 3; ++c)
    {
        const auto axis = static_cast<Eigen::Index>(c);
        size_[c]        = static_cast<std::int64_t>((high[axis] - low[axis]) * per_cell_) + 1;
    }
    reached_.resize(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]));
    for (std::size_t body = 0; body < count; ++body) { mark(world.bodies.position[body], reached(world, body, reach)); }
}

/// Marks the cells of the box around a sphere.
void ReachedCells::mark(const Vec3<double>& centre, double radius)
{
    std::array<std::int64_t, 3> first{}, last{};
    for (std::size_t c = 0; c < 3; ++c)
    {
        const auto   axis   = static_cast<Eigen::Index>(c);
        const double offset = centre[axis] - low_[axis];
        first[c]            = std::max<std::int64_t>(0, static_cast<std::int64_t>((offset - radius) * per_cell_));
        last[c]             = std::min(size_[c] - 1, static_cast<std::int64_t>((offset + radius) * per_cell_));
    }
    for (std::int64_t k = first[2]; k <= last[2]; ++k)
    {
        for (std::int64_t j = first[1]; j <= last[1]; ++j)
        {
            for (std::int64_t i = first[0]; i <= last[0]; ++i) { reached_[index(i, j, k)] = true; }
        }
    }
}

} // namespace tread::world
