#pragma once

#include "backend/launch.cuh"
#include "backend/warp.cuh"
#include "kernels/mpm/transfers/scatter_load.cuh"

namespace tread::mpm
{

/// Layout of the sums of a page with few points: node (x, y, z) is at x + row * y + layer * z. With these pitches, 32
/// neighbouring cells, each accessing the same node of its stencil, use 32 different banks.
constexpr int sparse_row   = 8;
constexpr int sparse_layer = 52;
constexpr int sparse_nodes = 5 * sparse_layer + 6 * sparse_row;

/// Scatters one page per warp, one point per lane, and no two points of one cell at a time: in each of 27 rounds every
/// lane adds to a different node. First come the first points of all cells, then the second ones, and so on.
template<class Real, class Brings>
struct ScatterSparsePage
{
    using Tile = Real[node_channels][sparse_nodes];

    PointsView<Real> points;
    PagesView        pages;
    PageList         list;
    Real*            tiles;

    __device__ void operator()(std::int64_t block) const
    {
        const std::int64_t page = list.at(block);
        if (pages.first_point[page] == pages.first_point[page + 1]) { return; }
        __shared__ Tile tile;
        __shared__ std::int32_t listed[page_cells];
        const int               lane = static_cast<int>(threadIdx.x);
        for (int n = lane; n < node_channels * sparse_nodes; n += warp_size) { (&tile[0][0])[n] = 0; }

        const std::int32_t* cells   = pages.cell_first_point + page * page_cells;
        const std::int32_t  first[] = {cells[lane], cells[lane + warp_size]};
        const std::int32_t  count[] = {cells[lane + 1] - first[0], cells[lane + warp_size + 1] - first[1]};
        const Index3        low     = page_coordinates(pages.point_page_key[page]);
        for (int turn = 0;; ++turn)
        {
            const int size = list_turn(turn, lane, first, count, listed);
            if (size == 0) { break; }
            for (int at = lane; at < page_cells; at += warp_size)
            {
                if (at - lane < size) { add(at < size ? listed[at] : -1, low, tile); }
            }
            __syncwarp();
        }
        write(lane, tile, tiles + page * node_channels * tile_nodes);
    }

    /// Lists the points with index `turn` in their cell, in the order of cells; returns their number.
    __device__ static int list_turn(int turn, int lane, const std::int32_t* first, const std::int32_t* count,
                                    std::int32_t* listed)
    {
        int size = 0;
        for (int half = 0; half < 2; ++half)
        {
            const bool     has  = turn < count[half];
            const unsigned mask = __ballot_sync(all_lanes, has);
            if (has) { listed[size + __popc(mask & ((1u << lane) - 1))] = first[half] + turn; }
            size += __popc(mask);
        }
        __syncwarp();
        return size;
    }

    /// Adds one point, or none (-1); all lanes take part.
    __device__ void add(std::int32_t at, Index3 low, Tile& tile) const
    {
        PointLoad<Real> load{};
        Stencil<Real>   s{};
        int             base = 0;
        if (at >= 0)
        {
            const std::int64_t i     = pages.point_at[at];
            const int          place = pages.place_at[at];
            load                     = point_load(points, i);
            s    = stencil_above<Real>(node_at(low, place), points.position.get(i), pages.inverse_spacing, pages);
            base = (place & 3) + sparse_row * (place >> 2 & 3) + sparse_layer * (place >> 4);
        }
#pragma unroll
        for (int c = 0; c < 3; ++c)
        {
#pragma unroll
            for (int b = 0; b < 3; ++b)
            {
                add_row(at >= 0, load, s, b, c, tile, base + sparse_row * b + sparse_layer * c);
            }
        }
    }

    /// Adds to three nodes along x. Common factors are computed once.
    __device__ void add_row(bool active, const PointLoad<Real>& load, const Stencil<Real>& s, int b, int c, Tile& tile,
                            int row) const
    {
        const Real spacing = static_cast<Real>(pages.spacing);
        const Real plane   = s.weight[1][b] * s.weight[2][c];
        const Real by_y = s.slope[1][b] * s.weight[2][c], by_z = s.weight[1][b] * s.slope[2][c];
        Real       value[node_channels], by_x[3];
        for (int k = 0; k < 4; ++k) { value[k] = plane * load.value[k]; }
        for (int k = 0; k < 3; ++k)
        {
            if (Brings::affine)
            {
                value[1 + k] += plane * spacing *
                                ((Real(b) - s.fraction[1]) * load.per_offset[1][1 + k] +
                                 (Real(c) - s.fraction[2]) * load.per_offset[2][1 + k]);
            }
            value[4 + k] = by_y * load.per_slope[1][4 + k] + by_z * load.per_slope[2][4 + k];
            if (Brings::force) { value[4 + k] += plane * load.value[4 + k]; }
            by_x[k] = plane * load.per_slope[0][4 + k];
        }
#pragma unroll
        for (int a = 0; a < 3; ++a)
        {
            __syncwarp();
            if (!active) { continue; }
            const Real weight = s.weight[0][a], slope = s.slope[0][a];
            tile[0][row + a] += weight * value[0];
            for (int k = 0; k < 3; ++k)
            {
                Real momentum = value[1 + k];
                if (Brings::affine)
                {
                    momentum += plane * spacing * (Real(a) - s.fraction[0]) * load.per_offset[0][1 + k];
                }
                tile[1 + k][row + a] += weight * momentum;
                tile[4 + k][row + a] += weight * value[4 + k] + slope * by_x[k];
            }
        }
    }

    /// Writes the tile; a lane writes a column of nodes of one channel at a time.
    __device__ static void write(int lane, const Tile& tile, Real* out)
    {
        __syncwarp();
        for (int item = lane; item < node_channels * layer_nodes; item += warp_size)
        {
            const int      channel = item / layer_nodes, x = item % tile_edge, y = item % layer_nodes / tile_edge;
            const TileSlot low = tile_slot(x, y, 0), high = tile_slot(x, y, page_edge);
            const int      step   = tile_slot(x, y, 1).first - low.first;
            const Real*    column = tile[channel] + x + sparse_row * y;
#pragma unroll
            for (int z = 0; z < tile_edge; ++z)
            {
                const TileSlot slot                                            = z < page_edge ? low : high;
                out[slot.first + z % page_edge * step + channel * slot.stride] = column[z * sparse_layer];
            }
        }
    }
};

} // namespace tread::mpm
