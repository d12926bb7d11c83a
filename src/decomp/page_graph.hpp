#pragma once

#include <cstdint>
#include <vector>

// Pages of a scene as a graph: vertices carry work, edges the cost of a cut.
namespace tread::decomp
{

/// Pages that hold points or bodies, linked where both reach the same grid nodes. Every edge is stored in both
/// directions.
struct PageGraph
{
    std::vector<std::uint64_t> key;       ///< [pages], ascending (kernels/mpm/pages/page_key.hpp)
    std::vector<double>        load;      ///< [pages], predicted work, in points; not negative
    std::vector<std::int64_t>  first;     ///< [pages + 1], start of each page's edges
    std::vector<std::int32_t>  neighbour; ///< [edges], index of a page
    std::vector<std::int32_t>
        shared; ///< [edges], nodes that both reach: 72 over a face, 24 over an edge, 8 over a corner

    std::size_t pages() const { return key.size(); }
};

/// Builds the graph. `key`: ascending and unique; `load`: of each key.
PageGraph page_graph(std::vector<std::uint64_t> key, std::vector<double> load);

} // namespace tread::decomp
