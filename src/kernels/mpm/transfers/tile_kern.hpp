#pragma once

#include "kernels/mpm/pages/page_key.hpp"

// Layout of a finished P2G tile. A node page reads its own part from each of the eight tiles that contribute to it:
// tiles are stored octant by octant, and within an octant channel by channel, so that this part is contiguous in
// memory.
namespace tread::mpm
{

/// Number of channels of a node: mass, momentum (3), force (3).
constexpr int node_channels = 7;

/// Number of octants; octant o of a tile belongs to the node page at + (o & 1, o >> 1 & 1, o >> 2).
constexpr int octants = 8;

TREAD_HD constexpr int octant_edge(int octant, int axis)
{
    return (octant >> axis & 1) != 0 ? tile_edge - page_edge : page_edge;
}

TREAD_HD constexpr int octant_nodes(int octant)
{
    return octant_edge(octant, 0) * octant_edge(octant, 1) * octant_edge(octant, 2);
}

/// Returns the index of an octant's first number in its tile.
TREAD_HD constexpr int octant_start(int octant)
{
    const int z = octant >> 2, y = octant >> 1 & 1, x = octant & 1;
    const int height = octant_edge(octant, 2);
    return node_channels * (z * page_edge * tile_edge * tile_edge + y * height * page_edge * tile_edge +
                            x * height * octant_edge(octant, 1) * page_edge);
}

/// Location of the channels of one node.
struct TileSlot
{
    int first;  ///< index of the lowest channel
    int stride; ///< stride between channels
};

TREAD_HD constexpr TileSlot tile_slot(int i, int j, int k)
{
    const int octant = (i / page_edge) | (j / page_edge) << 1 | (k / page_edge) << 2;
    return {octant_start(octant) + i % page_edge +
                octant_edge(octant, 0) * (j % page_edge + octant_edge(octant, 1) * (k % page_edge)),
            octant_nodes(octant)};
}

} // namespace tread::mpm
