#pragma once

#include <cmath>
#include <cstdint>

#include "backend/vector.hpp"

// A page has 4 x 4 x 4 cells. The cell of a point is named by the lowest node of its stencil, so that all points of a
// cell share their 27 nodes; the page of a node is its coordinates / 4. Keys are 57-bit Morton codes of page
// coordinates, so that a key and a place in the page (6 bits) fit into 64 bits.
namespace tread::mpm
{

constexpr int page_edge  = 4;
constexpr int page_cells = page_edge * page_edge * page_edge;

/// Number of nodes in the stencils of a page's cells, along one axis and in total.
constexpr int tile_edge  = page_edge + 2;
constexpr int tile_nodes = tile_edge * tile_edge * tile_edge;

/// Offset added to page coordinates before encoding, so that negative ones have keys as well.
constexpr std::int32_t page_bias = 1 << 18;

/// Key of points outside the domain: sorts after every page.
constexpr std::uint64_t no_page = ~0ull;

struct Index3
{
    std::int32_t x, y, z;
};

TREAD_HD std::uint64_t spread_bits(std::uint64_t v)
{
    v = (v | v << 32) & 0x001f00000000ffffull;
    v = (v | v << 16) & 0x001f0000ff0000ffull;
    v = (v | v << 8) & 0x100f00f00f00f00full;
    v = (v | v << 4) & 0x10c30c30c30c30c3ull;
    return (v | v << 2) & 0x1249249249249249ull;
}

TREAD_HD std::int32_t compact_bits(std::uint64_t v)
{
    v &= 0x1249249249249249ull;
    v = (v ^ v >> 2) & 0x10c30c30c30c30c3ull;
    v = (v ^ v >> 4) & 0x100f00f00f00f00full;
    v = (v ^ v >> 8) & 0x001f0000ff0000ffull;
    v = (v ^ v >> 16) & 0x001f00000000ffffull;
    return static_cast<std::int32_t>((v ^ v >> 32) & 0x1fffffull);
}

/// Returns the Morton key of page coordinates in [-2^18, 2^18).
TREAD_HD std::uint64_t page_key(Index3 page)
{
    return spread_bits(static_cast<std::uint64_t>(page.x + page_bias)) |
           spread_bits(static_cast<std::uint64_t>(page.y + page_bias)) << 1 |
           spread_bits(static_cast<std::uint64_t>(page.z + page_bias)) << 2;
}

TREAD_HD Index3 page_coordinates(std::uint64_t key)
{
    return {compact_bits(key) - page_bias, compact_bits(key >> 1) - page_bias, compact_bits(key >> 2) - page_bias};
}

/// Returns the page of a node (or of a cell, named by its lowest node).
TREAD_HD Index3 page_of(Index3 node) { return {node.x >> 2, node.y >> 2, node.z >> 2}; }

/// Returns the place of a node within its page, 0..63.
TREAD_HD int place_in_page(Index3 node) { return (node.x & 3) | (node.y & 3) << 2 | (node.z & 3) << 4; }

/// Returns the node at a place of a page.
TREAD_HD Index3 node_at(Index3 page, int place)
{
    return {page.x * page_edge + (place & 3), page.y * page_edge + (place >> 2 & 3), page.z * page_edge + (place >> 4)};
}

/// Key that orders cells by page, then by place in the page.
TREAD_HD std::uint64_t cell_key(Index3 cell)
{
    return page_key(page_of(cell)) << 6 | static_cast<std::uint64_t>(place_in_page(cell));
}

} // namespace tread::mpm
