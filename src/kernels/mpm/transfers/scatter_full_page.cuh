#pragma once

#include "backend/launch.cuh"
#include "backend/pack.hpp"
#include "backend/warp.cuh"
#include "kernels/mpm/transfers/scatter_load.cuh"

namespace tread::mpm
{

constexpr int layer_cells = page_edge * page_edge;

template<class Real>
using Pair = Pack<Real, 2>;
template<class Real>
using Quad = Pack<Real, 4>;

/// Layout of a point's P2G data in shared memory: mass and momentum, -V tau/h, weight and slope (per spacing) of each
/// of its three nodes along each axis. Then the data that only some scenes need: contact force, and m h C, with which
/// the momentum is that of the point's affine field at its lowest node.
enum Brought : int
{
    brought_mass    = 0,
    brought_stress  = 4,
    brought_splines = 10,
    brought_force   = brought_splines + 18,
    brought_affine  = brought_force + 4
};

/// Number of values per point: an odd number of quads, so that lanes write their points without bank conflicts.
template<class Brings>
constexpr int brought_width = Brings::affine  ? brought_affine + 12
                              : Brings::force ? brought_force + 8
                                              : brought_force;

/// Number of warps: one for each of the four layers of cells of a page; a warp's stencils cover three of the tile's
/// layers of nodes.
constexpr int scatter_warps   = page_edge;
constexpr int scatter_threads = scatter_warps * warp_size;
constexpr int warp_nodes      = 3 * layer_nodes;

/// Nodes in the stencils of a warp's cells. The odd pitch keeps the channels that lanes add at the same time in
/// different banks.
template<class Real>
struct WarpTile
{
    Real channel[node_channels][warp_nodes + 1];
};

/// Number of points loaded at a time: as many as fit into 48 KiB of shared memory besides the tiles of four warps.
template<class Real, class Brings>
__host__ __device__ constexpr int batch()
{
    constexpr std::size_t room = 49152 / scatter_warps - sizeof(WarpTile<Real>);
    int                   size = warp_size;
    while (sizeof(Real) * brought_width<Brings> * static_cast<std::size_t>(size) > room) { size /= 2; }
    return size;
}

/// One lane of a warp. Nine lanes share a point: each handles the three nodes along x of one row of the stencil, (row,
/// layer), and reads what the point brings once for all three. The three groups of nine lanes take the points of a cell
/// in turn. Sums stay in registers: from one cell to the next along x they move by one node, and the node that is left
/// is added to the warp's tile, each group the sums of three channels.
template<class Real, class Brings>
class NodeRow
{
public:
    __device__ NodeRow(int lane, WarpTile<Real>& tile)
        : group_(lane < groups * group_lanes ? lane / group_lanes : warp_size)
        , row_(lane % 3)
        , layer_(lane / 3 % 3)
        , channels_(min(group_channels, node_channels - group_channels * group_))
        , low_(&tile.channel[0][0] + (channels_ > 0 ? group_channels * group_ : 0) * (warp_nodes + 1) +
               tile_edge * (row_ + tile_edge * layer_))
    {
        for (int k = 1; k < groups; ++k)
        {
            taker_[k - 1] = (group_ + groups - k) % groups;
            giver_[k - 1] = (group_ + k) % groups * group_lanes + 3 * layer_ + row_;
        }
    }

    /// Adds points `first` to `end` of those brought, which are all of one cell.
    template<int quads>
    __device__ void add(const Quad<Real> (*brought)[quads], int first, int end)
    {
        for (int point = first + group_; point < end; point += groups) { add(brought[point]); }
    }

    /// Adds the row's first node, in column x above row y of cells, to the tile, and moves the sums of the others down.
    /// All lanes take part.
    __device__ void leave(int x, int y)
    {
        Real sum[group_channels];
#pragma unroll
        for (int c = 0; c < group_channels; ++c) { sum[c] = over_groups(c); }
        __syncwarp(); // other lanes may have added to the node, as another row of an earlier cell
        Real* node = low_ + x + tile_edge * y;
#pragma unroll
        for (int c = 0; c < group_channels; ++c)
        {
            if (c < channels_) { node[c * (warp_nodes + 1)] += sum[c]; }
        }
#pragma unroll
        for (int c = 0; c < node_channels; ++c)
        {
            sums_[0][c] = sums_[1][c];
            sums_[1][c] = sums_[2][c];
            sums_[2][c] = 0;
        }
    }

private:
    static constexpr int group_lanes = 9, groups = 3, group_channels = 3;

    /// Sums of one node: mass and momentum, then force.
    using Sums = Real[node_channels];

    __device__ static Pair<Real> pair(const Real* at) { return *reinterpret_cast<const Pair<Real>*>(at); }

    __device__ void add(const Quad<Real>* brought)
    {
        const Real*      point  = &brought->at[0];
        const Quad<Real> mass   = brought[0];
        const Quad<Real> normal = brought[1];                       // xx yy zz yz
        const Pair<Real> shear  = pair(point + brought_stress + 4); // xz xy
        const Pair<Real> y      = pair(point + brought_splines + 6 + 2 * row_);
        const Pair<Real> z      = pair(point + brought_splines + 12 + 2 * layer_);
        const Real       plane = y.at[0] * z.at[0], by_y = y.at[1] * z.at[0], by_z = y.at[0] * z.at[1];
        const Real       stress[3][3] = {{normal.at[0], shear.at[1], shear.at[0]},
                                         {shear.at[1], normal.at[1], normal.at[3]},
                                         {shear.at[0], normal.at[3], normal.at[2]}};
        Real             momentum[]   = {mass.at[1], mass.at[2], mass.at[3]}, turn[3], along[3], across[3];
        if constexpr (Brings::affine) { turned(point, momentum, turn); }
        for (int i = 0; i < 3; ++i)
        {
            along[i]  = plane * stress[i][0];
            across[i] = std::fma(by_y, stress[i][1], by_z * stress[i][2]);
            if constexpr (Brings::force) { across[i] = std::fma(plane, point[brought_force + i], across[i]); }
        }
#pragma unroll
        for (int n = 0; n < 3; ++n)
        {
            const Pair<Real> x      = pair(point + brought_splines + 2 * n);
            const Real       weight = x.at[0] * plane;
            Sums&            sum    = sums_[n];
            sum[0]                  = std::fma(weight, mass.at[0], sum[0]);
            for (int i = 0; i < 3; ++i)
            {
                sum[1 + i] = std::fma(weight, momentum[i], sum[1 + i]);
                sum[4 + i] = std::fma(x.at[1], along[i], std::fma(x.at[0], across[i], sum[4 + i]));
                if constexpr (Brings::affine) { momentum[i] += turn[i]; }
            }
        }
    }

    /// Makes the momentum that of the affine velocity at the row's first node, which is (0, row, layer) above the
    /// stencil's lowest, and writes by how much it differs from one node of the row to the next.
    __device__ void turned(const Real* point, Real* momentum, Real* step) const
    {
        const Real       y = Real(row_), z = Real(layer_);
        const auto*      quad = reinterpret_cast<const Quad<Real>*>(point + brought_affine);
        const Quad<Real> low = quad[0], high = quad[1];
        momentum[0] = std::fma(y, low.at[3], std::fma(z, high.at[2], momentum[0]));
        momentum[1] = std::fma(y, high.at[0], std::fma(z, high.at[3], momentum[1]));
        momentum[2] = std::fma(y, high.at[1], std::fma(z, point[brought_affine + 8], momentum[2]));
        for (int i = 0; i < 3; ++i) { step[i] = low.at[i]; }
    }

    /// Returns the sum over all groups of the group's channel `c`, 0..2, of the first node.
    __device__ Real over_groups(int c) const
    {
        Real sum = first_node(group_, c);
#pragma unroll
        for (int k = 0; k < groups - 1; ++k) { sum += __shfl_sync(all_lanes, first_node(taker_[k], c), giver_[k]); }
        return sum;
    }

    /// Returns channel `c` of those of a group, 0 where it has none, without an index into registers.
    __device__ Real first_node(int group, int c) const
    {
        const Real last = 2 * group_channels + c < node_channels ? sums_[0][2 * group_channels + c] : Real(0);
        return group == 0 ? sums_[0][c] : group == 1 ? sums_[0][group_channels + c] : last;
    }

    int   group_, row_, layer_;
    int   channels_;          ///< number of a node's channels that the lane adds to the tile
    Real* low_;               ///< the first of them, of the row's first node in the layer's first cell
    int   taker_[groups - 1]; ///< groups that take the lane's sums of their channels
    int   giver_[groups - 1]; ///< lanes whose sums of its channels it takes
    Sums  sums_[3]{};
};

/// Scatters one page per block. Each warp takes the points of its layer of cells in the order of the list, in batches:
/// a lane loads a point into shared memory, then nine lanes add it, each to its own row of nodes. The additions have a
/// fixed order and no atomics.
template<class Real, class Brings>
struct ScatterPage
{
    static constexpr int points_a_batch = batch<Real, Brings>();
    static constexpr int quads          = brought_width<Brings> / 4;
    static constexpr int blocks         = sizeof(Real) == 4 ? 7 : 4; ///< a multiprocessor; leaves sums in registers

    using Tile = WarpTile<Real>;

    PointsView<Real> points;
    PagesView        pages;
    PageList         list;
    Real*            tiles;

    __device__ void operator()(std::int64_t block) const
    {
        const std::int64_t page = list.at(block);
        if (pages.first_point[page] == pages.first_point[page + 1]) { return; }
        __shared__ Tile tile[scatter_warps];
        __shared__ Quad<Real> staged[scatter_warps][points_a_batch][quads];
        const int             warp  = static_cast<int>(threadIdx.x) / warp_size;
        const int             lane  = static_cast<int>(threadIdx.x) % warp_size;
        Real*                 zeros = &tile[warp].channel[0][0];
        for (int n = lane; n < static_cast<int>(sizeof(Tile) / sizeof(Real)); n += warp_size) { zeros[n] = 0; }
        __syncwarp();
        add_points(page, warp, lane, tile[warp], staged[warp]);
        __syncthreads();
        write(tile, tiles + page * node_channels * tile_nodes);
    }

    __device__ void add_points(std::int64_t page, int warp, int lane, Tile& tile, Quad<Real> (*staged)[quads]) const
    {
        NodeRow<Real, Brings> nodes(lane, tile);

        const Index3        low   = page_coordinates(pages.point_page_key[page]);
        const std::int32_t* range = pages.cell_first_point + page * page_cells + warp * layer_cells;
        const std::int32_t  first = range[min(lane, layer_cells)], all = __shfl_sync(all_lanes, first, layer_cells);
        std::int32_t        at = __shfl_sync(all_lanes, first, 0), staged_from = at, staged_to = at;
        int                 held = 0; // nodes of the row whose sums are not zero
        for (int cell = 0; cell < layer_cells; ++cell)
        {
            const std::int32_t end = __shfl_sync(all_lanes, first, cell + 1);
            if (at < end) { held = 3; }
            while (at < end)
            {
                if (at == staged_to)
                {
                    staged_from = at;
                    staged_to   = min(at + points_a_batch, all);
                    stage_batch(at, staged_to, lane, low, staged);
                }
                const std::int32_t stop = min(end, staged_to);
                nodes.add(staged, at - staged_from, stop - staged_from);
                at = stop;
            }
            const int x = cell % page_edge, y = cell / page_edge;
            for (int left = x; left < (x < page_edge - 1 ? x + 1 : tile_edge) && held > 0; ++left, --held)
            {
                nodes.leave(left, y);
            }
        }
    }

    /// Loads listed points `first` to `end`, a lane each, once all lanes are done with those before.
    __device__ void stage_batch(std::int32_t first, std::int32_t end, int lane, Index3 low,
                                Quad<Real> (*staged)[quads]) const
    {
        __syncwarp();
        const std::int32_t at = first + lane;
        if (at < end) { stage(pages.point_at[at], node_at(low, pages.place_at[at]), &staged[lane][0].at[0]); }
        __syncwarp();
    }

    __device__ void stage(std::int64_t i, Index3 cell, Real* brought) const
    {
        const Stencil<Real>    s     = stencil_above<Real>(cell, points.position.get(i), 1, pages);
        const PointTerms<Real> terms = point_terms(points, i, Real(pages.inverse_spacing));
        brought[brought_mass]        = terms.mass;
        for (int c = 0; c < 3; ++c)
        {
            brought[brought_mass + 1 + c] = terms.momentum[c];
            for (int n = 0; n < 3; ++n)
            {
                brought[brought_splines + 6 * c + 2 * n]     = s.weight[c][n];
                brought[brought_splines + 6 * c + 2 * n + 1] = s.slope[c][n];
            }
        }
        for (int c = 0; c < 6; ++c) { brought[brought_stress + c] = terms.stress[c]; }
        if constexpr (Brings::force) { stage_force(i, brought); }
        if constexpr (Brings::affine) { stage_affine(i, s, terms.mass, brought); }
    }

    __device__ void stage_force(std::int64_t i, Real* brought) const
    {
        const Vec3<Real> force = point_force(points, i);
        for (int c = 0; c < 3; ++c) { brought[brought_force + c] = force[c]; }
    }

    __device__ void stage_affine(std::int64_t i, const Stencil<Real>& s, Real mass, Real* brought) const
    {
        const Real lever = mass * static_cast<Real>(pages.spacing);
        for (int c = 0; c < 3; ++c)
        {
            for (int axis = 0; axis < 3; ++axis)
            {
                const Real affine                      = affine_momentum(points, i, lever, c, axis);
                brought[brought_affine + 3 * axis + c] = affine;
                brought[brought_mass + 1 + c] -= s.fraction[axis] * affine;
            }
        }
    }

    /// Writes the tile: a thread sums a column of nodes over the contributing warps, from low to high, channel by
    /// channel.
    __device__ static void write(const Tile* tile, Real* out)
    {
        for (int item = threadIdx.x; item < node_channels * layer_nodes; item += scatter_threads)
        {
            const int      channel = item / layer_nodes, column = item % layer_nodes;
            const int      x = column % tile_edge, y = column / tile_edge;
            const TileSlot low = tile_slot(x, y, 0), high = tile_slot(x, y, page_edge);
            const int      step = tile_slot(x, y, 1).first - low.first;
#pragma unroll
            for (int z = 0; z < tile_edge; ++z)
            {
                Real sum = 0;
#pragma unroll
                for (int warp = 0; warp < scatter_warps; ++warp)
                {
                    const int above = z - warp;
                    if (above < 0 || above > 2) { continue; }
                    sum += tile[warp].channel[channel][column + above * layer_nodes];
                }
                const TileSlot slot                                            = z < page_edge ? low : high;
                out[slot.first + z % page_edge * step + channel * slot.stride] = sum;
            }
        }
    }
};

} // namespace tread::mpm
