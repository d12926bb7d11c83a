#pragma once

#include "backend/launch.cuh"
#include "backend/pack.hpp"
#include "backend/warp.cuh"
#include "kernels/mpm/transfers/scatter_load.cuh"

namespace tread::mpm
{

constexpr int point_nodes = 27;
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

/// Nodes in the stencils of a warp's cells: mass and momentum, then force.
template<class Real>
struct WarpTile
{
    Quad<Real> moving[warp_nodes];
    Quad<Real> force[warp_nodes];
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

/// One lane of a warp: of every point's 27 nodes it handles one, (column, row, layer). Along x, its column is the one
/// of the point's three nodes whose coordinate is `column` modulo 3, so that from one cell to the next two thirds of
/// the lanes keep their node, and with it the sums in their registers.
template<class Real, class Brings>
class NodeLane
{
public:
    __device__ NodeLane(int lane, WarpTile<Real>& tile)
        : tile_(tile)
        , working_(lane < point_nodes)
        , column_(lane % 3)
        , row_(lane / 3 % 3)
        , layer_(working_ ? lane / 9 : 0)
    {
    }

    /// Moves to the stencil of a cell of the layer, 0..15. All lanes take part.
    __device__ void go_to(int cell)
    {
        const int x = cell % page_edge, y = cell / page_edge;
        offset_         = column_ >= x ? column_ - x : column_ - x + 3;
        const int  node = x + offset_ + tile_edge * (y + row_ + tile_edge * layer_);
        const bool left = working_ && node != node_;
        if (left) { store(); }
        __syncwarp();
        if (left)
        {
            moving_ = tile_.moving[node];
            force_  = tile_.force[node];
            node_   = node;
        }
    }

    __device__ void add(const Quad<Real>* brought)
    {
        const Real*      point      = &brought->at[0];
        const Quad<Real> mass       = brought[0];
        const Quad<Real> normal     = brought[1];                       // xx yy zz yz
        const Pair<Real> shear      = pair(point + brought_stress + 4); // xz xy
        const Pair<Real> x          = pair(point + brought_splines + 2 * offset_);
        const Pair<Real> y          = pair(point + brought_splines + 6 + 2 * row_);
        const Pair<Real> z          = pair(point + brought_splines + 12 + 2 * layer_);
        const Real       yz         = y.at[0] * z.at[0];
        const Real       weight     = x.at[0] * yz;
        const Real       slope[]    = {x.at[1] * yz, y.at[1] * (x.at[0] * z.at[0]), z.at[1] * (x.at[0] * y.at[0])};
        Real             momentum[] = {mass.at[1], mass.at[2], mass.at[3]};
        if constexpr (Brings::affine) { turn(point, momentum); }
        moving_.at[0] += weight * mass.at[0];
        for (int i = 0; i < 3; ++i) { moving_.at[1 + i] += weight * momentum[i]; }
        const Real stress[3][3] = {{normal.at[0], shear.at[1], shear.at[0]},
                                   {shear.at[1], normal.at[1], normal.at[3]},
                                   {shear.at[0], normal.at[3], normal.at[2]}};
        for (int i = 0; i < 3; ++i)
        {
            for (int j = 0; j < 3; ++j) { force_.at[i] += slope[j] * stress[i][j]; }
            if constexpr (Brings::force) { force_.at[i] += weight * point[brought_force + i]; }
        }
    }

    __device__ void store()
    {
        if (node_ < 0) { return; }
        tile_.moving[node_] = moving_;
        tile_.force[node_]  = force_;
    }

private:
    __device__ static Pair<Real> pair(const Real* at) { return *reinterpret_cast<const Pair<Real>*>(at); }

    /// Adds the momentum of the affine velocity at the lane's node, which is (offset, row, layer) above the lowest.
    __device__ void turn(const Real* point, Real* momentum) const
    {
        const Real       x = Real(offset_), y = Real(row_), z = Real(layer_);
        const auto*      quad = reinterpret_cast<const Quad<Real>*>(point + brought_affine);
        const Quad<Real> low = quad[0], high = quad[1];
        const Real       last = point[brought_affine + 8];
        momentum[0] += x * low.at[0] + y * low.at[3] + z * high.at[2];
        momentum[1] += x * low.at[1] + y * high.at[0] + z * high.at[3];
        momentum[2] += x * low.at[2] + y * high.at[1] + z * last;
    }

    WarpTile<Real>& tile_;
    bool            working_;
    int             column_, row_, layer_;
    int             offset_ = 0, node_ = -1;
    Quad<Real>      moving_{}, force_{};
};

/// Scatters one page per block. Each warp takes the points of its layer of cells in the order of the list, in batches:
/// a lane loads a point into shared memory, then all lanes add every point, each to its own node. The additions have a
/// fixed order and no atomics.
template<class Real, class Brings>
struct ScatterPage
{
    static constexpr int points_a_batch = batch<Real, Brings>();
    static constexpr int quads          = brought_width<Brings> / 4;

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
        const int             warp = static_cast<int>(threadIdx.x) / warp_size;
        const int             lane = static_cast<int>(threadIdx.x) % warp_size;
        for (int node = lane; node < warp_nodes; node += warp_size)
        {
            tile[warp].moving[node] = {};
            tile[warp].force[node]  = {};
        }
        __syncwarp();
        add_points(page, warp, lane, tile[warp], staged[warp]);
        __syncthreads();
        write(tile, tiles + page * node_channels * tile_nodes);
    }

    __device__ void add_points(std::int64_t page, int warp, int lane, Tile& tile, Quad<Real> (*staged)[quads]) const
    {
        NodeLane<Real, Brings> node(lane, tile);

        const Index3        low   = page_coordinates(pages.point_page_key[page]);
        const std::int32_t* range = pages.cell_first_point + page * page_cells + warp * layer_cells;
        const std::int32_t  end   = range[layer_cells];
        int                 last  = -1;
        for (std::int32_t first = range[0]; first < end; first += points_a_batch)
        {
            const int count = min(points_a_batch, end - first);
            int       place = last;
            if (lane < count)
            {
                place = pages.place_at[first + lane];
                stage(pages.point_at[first + lane], node_at(low, place), &staged[lane][0].at[0]);
            }
            const int before = __shfl_up_sync(all_lanes, place, 1);
            unsigned  heads  = __ballot_sync(all_lanes, lane < count && place != (lane == 0 ? last : before));
            last             = __shfl_sync(all_lanes, place, count - 1);
            __syncwarp();
            for (int at = 0; at < count;)
            {
                if ((heads >> at & 1u) != 0)
                {
                    node.go_to(__shfl_sync(all_lanes, place, at) - warp * layer_cells);
                    heads &= heads - 1;
                }
                const int stop = heads != 0 ? __ffs(static_cast<int>(heads)) - 1 : count;
                for (; at < stop; ++at) { node.add(staged[at]); }
            }
            __syncwarp();
        }
        node.store();
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

    /// Writes the tile: a thread sums a column of nodes over the contributing warps, from low to high: mass and
    /// momentum, or force.
    __device__ static void write(const Tile* tile, Real* out)
    {
        for (int item = threadIdx.x; item < 2 * layer_nodes; item += scatter_threads)
        {
            const int column = item % layer_nodes, x = column % tile_edge, y = column / tile_edge;
            if (item < layer_nodes)
            {
                write_column<0, 4>(column, x, y, out, [&](int w, int n) { return tile[w].moving[n]; });
            }
            else
            {
                write_column<4, 3>(column, x, y, out, [&](int w, int n) { return tile[w].force[n]; });
            }
        }
    }

    template<int first, int channels, class Value>
    __device__ static void write_column(int column, int x, int y, Real* out, Value value)
    {
        const TileSlot low = tile_slot(x, y, 0), high = tile_slot(x, y, page_edge);
        const int      step = tile_slot(x, y, 1).first - low.first;
#pragma unroll
        for (int z = 0; z < tile_edge; ++z)
        {
            Quad<Real> sum{};
#pragma unroll
            for (int warp = 0; warp < scatter_warps; ++warp)
            {
                const int above = z - warp;
                if (above < 0 || above > 2) { continue; }
                const Quad<Real> part = value(warp, column + above * layer_nodes);
                for (int c = 0; c < channels; ++c) { sum.at[c] += part.at[c]; }
            }
            const TileSlot slot = z < page_edge ? low : high;
            Real*          to   = out + slot.first + z % page_edge * step + first * slot.stride;
            for (int c = 0; c < channels; ++c) { to[c * slot.stride] = sum.at[c]; }
        }
    }
};

} // namespace tread::mpm
