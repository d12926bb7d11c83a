#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "shape/mesh/half_edges.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/mesh/triangle_tree.hpp"
#include "shape/repair/repair_steps.hpp"

namespace tread::shape
{
namespace
{

std::vector<HalfEdge> open_edges(const TriangleMesh& mesh)
{
    std::vector<HalfEdge> open;
    for_each_edge(sorted_half_edges(mesh),
                  [&](auto first, auto last)
                  {
                      if (last - first == 1) { open.push_back(*first); }
                  });
    return open;
}

std::vector<std::int32_t> end_points(const std::vector<HalfEdge>& edges)
{
    std::vector<std::int32_t> vertices;
    for (const HalfEdge& edge : edges) { vertices.insert(vertices.end(), {edge.low, edge.high}); }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

/// Position of a vertex on its edge: 0 at low, 1 at high.
using OnEdge = std::pair<double, std::int32_t>;

/// Finds for each open edge the open vertices within the tolerance of its interior, from low to high. A genuine seam
/// has about one match per vertex; if far more match, the search gives up.
std::vector<std::vector<OnEdge>> match(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges, double tolerance)
{
    TriangleMesh segments{mesh.vertices, {}};
    for (const HalfEdge& edge : edges) { segments.triangles.push_back({edge.low, edge.high, edge.high}); }
    const TriangleTree               tree = build_tree(segments);
    std::vector<std::vector<OnEdge>> found(edges.size());
    std::size_t                      left = 1000 + 16 * edges.size();
    for (const std::int32_t vertex : end_points(edges))
    {
        const Eigen::Vector3d& place = mesh.vertices[static_cast<std::size_t>(vertex)];
        const Eigen::Vector3d  reach = Eigen::Vector3d::Constant(tolerance);
        for (const std::int32_t at : triangles_touching(tree, {place - reach, place + reach}, left))
        {
            if (--left == 0) { return {}; }
            const HalfEdge& edge = edges[static_cast<std::size_t>(at)];
            if (vertex == edge.low || vertex == edge.high) { continue; }
            const Eigen::Vector3d& low  = mesh.vertices[static_cast<std::size_t>(edge.low)];
            const Eigen::Vector3d  way  = mesh.vertices[static_cast<std::size_t>(edge.high)] - low;
            const double           part = (place - low).dot(way) / way.squaredNorm();
            if (part > 0 && part < 1 && (low + part * way - place).norm() <= tolerance)
            {
                found[static_cast<std::size_t>(at)].emplace_back(part, vertex);
            }
        }
    }
    for (auto& on_edge : found) { std::sort(on_edge.begin(), on_edge.end()); }
    return found;
}

/// Replaces the triangle of the edge by a fan from its apex to the pieces of the edge.
void divide(TriangleMesh& mesh, const HalfEdge& edge, const std::vector<OnEdge>& on_edge)
{
    const auto t       = static_cast<std::size_t>(edge.triangle);
    const auto corners = mesh.triangles[t];
    const auto side    = static_cast<std::size_t>(edge.side);
    const auto apex    = corners[(side + 2) % 3];

    std::vector<std::int32_t> along{edge.low};
    for (const OnEdge& entry : on_edge) { along.push_back(entry.second); }
    along.push_back(edge.high);
    if (corners[side] != edge.low) { std::reverse(along.begin(), along.end()); }
    mesh.triangles[t] = {along[0], along[1], apex};
    for (std::size_t i = 2; i < along.size(); ++i) { mesh.triangles.push_back({along[i - 1], along[i], apex}); }
}

/// Splits at most one edge of each triangle; returns how many.
std::int64_t split_once(TriangleMesh& mesh, double tolerance)
{
    const std::vector<HalfEdge> edges = open_edges(mesh);
    if (edges.empty()) { return 0; }
    const auto                found = match(mesh, edges, tolerance);
    std::vector<std::uint8_t> divided(mesh.triangles.size(), 0);
    std::int64_t              count = 0;
    for (std::size_t e = 0; e < found.size(); ++e)
    {
        const auto  triangle = static_cast<std::size_t>(edges[e].triangle);
        const auto& corners  = mesh.triangles[triangle];
        const auto  apex     = corners[static_cast<std::size_t>((edges[e].side + 2) % 3)];
        const bool  has_apex =
            std::any_of(found[e].begin(), found[e].end(), [&](const OnEdge& entry) { return entry.second == apex; });
        if (found[e].empty() || has_apex || divided[triangle] != 0) { continue; }
        divided[triangle] = 1;
        divide(mesh, edges[e], found[e]);
        ++count;
    }
    return count;
}

} // namespace

void split_seams(TriangleMesh& mesh, RepairReport& report)
{
    // A triangle has three edges, and one more round shows that nothing remains.
    for (int round = 0; round < 4; ++round)
    {
        const std::int64_t count = split_once(mesh, report.tolerance);
        report.split_seams += count;
        if (count == 0) { return; }
    }
}

} // namespace tread::shape
