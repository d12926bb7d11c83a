#include "shape/mesh.hpp"

#include <algorithm>
#include <tuple>

#include "shape/half_edges.hpp"

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
    std::vector<HalfEdge> half_edges;
    half_edges.reserve(3 * mesh.triangles.size());
    std::int32_t triangle = 0;
    for (const auto& corners : mesh.triangles)
    {
        for (std::int32_t side = 0; side < 3; ++side)
        {
            const std::int32_t from = corners[static_cast<std::size_t>(side)];
            const std::int32_t to   = corners[static_cast<std::size_t>((side + 1) % 3)];
            half_edges.push_back({std::min(from, to), std::max(from, to), triangle, side});
        }
        ++triangle;
    }
    std::sort(half_edges.begin(), half_edges.end(),
              [](const HalfEdge& a, const HalfEdge& b)
              { return std::tie(a.low, a.high, a.triangle, a.side) < std::tie(b.low, b.high, b.triangle, b.side); });
    return half_edges;
}

} // namespace tread::shape
