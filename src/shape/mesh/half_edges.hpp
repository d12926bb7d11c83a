#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// One side of a triangle: from corner `side` to the next corner.
struct HalfEdge
{
    std::int32_t low;  ///< smaller vertex index
    std::int32_t high; ///< larger vertex index
    std::int32_t triangle;
    std::int32_t side;

    bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

/// Whether the half edge goes from its low to its high vertex.
inline bool runs_upwards(const TriangleMesh& mesh, const HalfEdge& half_edge)
{
    const auto& corners = mesh.triangles[static_cast<std::size_t>(half_edge.triangle)];
    return corners[static_cast<std::size_t>(half_edge.side)] == half_edge.low;
}

/// All 3 x triangles half edges, sorted so that those of one edge are adjacent, in the order of their triangles.
std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh);

/// Calls f(first, last) with iterators to the half edges of each edge.
template<class F>
void for_each_edge(const std::vector<HalfEdge>& half_edges, F f)
{
    for (auto first = half_edges.begin(); first != half_edges.end();)
    {
        auto last = first;
        while (last != half_edges.end() && last->same_edge(*first)) { ++last; }
        f(first, last);
        first = last;
    }
}

} // namespace tread::shape
