#pragma once

#include <cstdint>
#include <vector>

// The pages of a scene as a graph: what the work is, and what a cut through it costs.
namespace tread::decomp
{

/// Pages that hold points or bodies, and which of them reach the same nodes of the grid. Every edge stands twice.
struct PageGraph
{
    std::vector<std::uint64_t> key;       ///< [pages], ascending (kernels/mpm/pages/page_key.hpp)
    std::vector<double>        load;      ///< [pages], predicted work, in points; not negative
    std::vector<std::int64_t>  first;     ///< [pages + 1], the edges of each page
    std::vector<std::int32_t>  neighbour; ///< [edges], a page
    std::vector<std::int32_t>  shared;    ///< [edges], nodes that both reach: 72 over a face, 24 over an edge, 8

    std::size_t pages() const { return key.size(); }
};

/// `key` ascending, each once, and the load of each.
PageGraph page_graph(std::vector<std::uint64_t> key, std::vector<double> load);

} // namespace tread::decomp
