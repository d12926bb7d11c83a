#include "shape/mesh/mesh.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

#include "shape/mesh/half_edges.hpp"

namespace tread::shape
{

Bounds bounds(const TriangleMesh& mesh)
{
    Bounds box{mesh.vertices.at(0), mesh.vertices.at(0)};
    for (const Eigen::Vector3d& vertex : mesh.vertices)
    {
        box.low  = box.low.cwiseMin(vertex);
        box.high = box.high.cwiseMax(vertex);
    }
    return box;
}

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh)
{
    // Bucket sort by low vertex; only the few edges of one vertex need comparing.
    const auto each_half_edge = [&](const auto& f)
    {
        std::int32_t triangle = 0;
        for (const auto& corners : mesh.triangles)
        {
            for (std::int32_t side = 0; side < 3; ++side)
            {
                const std::int32_t from = corners[static_cast<std::size_t>(side)];
                const std::int32_t to   = corners[static_cast<std::size_t>((side + 1) % 3)];
                f(HalfEdge{std::min(from, to), std::max(from, to), triangle, side});
            }
            ++triangle;
        }
    };
    std::vector<std::size_t> next(mesh.vertices.size() + 1, 0);
    each_half_edge([&](const HalfEdge& half) { ++next[static_cast<std::size_t>(half.low) + 1]; });
    std::partial_sum(next.begin(), next.end(), next.begin());

    std::vector<HalfEdge> half_edges(3 * mesh.triangles.size());
    each_half_edge([&](const HalfEdge& half) { half_edges[next[static_cast<std::size_t>(half.low)]++] = half; });
    std::size_t first = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    {
        std::sort(half_edges.begin() + static_cast<std::ptrdiff_t>(first),
                  half_edges.begin() + static_cast<std::ptrdiff_t>(next[v]),
                  [](const HalfEdge& a, const HalfEdge& b)
                  { return std::tie(a.high, a.triangle, a.side) < std::tie(b.high, b.triangle, b.side); });
        first = next[v];
    }
    return half_edges;
}

} // namespace tread::shape
