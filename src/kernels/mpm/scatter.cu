#include "kernels/mpm/scatter.hpp"

#include "backend/launch.cuh"
#include "backend/pack.hpp"
#include "kernels/mpm/scatter_kern.hpp"

namespace tread::mpm
{
namespace
{

constexpr unsigned all_lanes   = 0xffffffffu;
constexpr int      warp_size   = 32;
constexpr int      point_nodes = 27;
constexpr int      layer_cells = page_edge * page_edge;
constexpr int      layer_nodes = tile_edge * tile_edge;

template<class Real>
using Pair = Pack<Real, 2>;
template<class Real>
using Quad = Pack<Real, 4>;

/// What a point brings to its nodes, as it stands in shared memory: mass and momentum, -V tau/h, weight and slope
/// (per spacing) of each of its three nodes along each axis; then what only some scenes need: contact force, place
/// above its lowest node, m h C.
enum Brought : int
{
    brought_mass     = 0,
    brought_stress   = 4,
    brought_splines  = 10,
    brought_force    = brought_splines + 18,
    brought_fraction = brought_force + 3,
    brought_affine   = brought_fraction + 3
};

/// Sand alone; sand that bodies touch; APIC, whose momentum varies over a point's stencil. `width`: an odd number of
/// quads, so that lanes write their points without bank conflicts.
struct PlainLoad
{
    static constexpr bool force = false, affine = false;
    static constexpr int  width = brought_force;
};
struct ContactLoad
{
    static constexpr bool force = true, affine = false;
    static constexpr int  width = brought_force + 8;
};
struct AffineLoad
{
    static constexpr bool force = true, affine = true;
    static constexpr int  width = brought_affine + 10;
};

/// A warp for each of the four layers of cells of a page; its stencils reach three of the tile's layers of nodes.
constexpr int scatter_warps   = page_edge;
constexpr int scatter_threads = scatter_warps * warp_size;
constexpr int warp_nodes      = 3 * layer_nodes;

/// The nodes that a warp's cells reach: mass and momentum, then force.
template<class Real>
struct WarpTile
{
    Quad<Real> moving[warp_nodes];
    Quad<Real> force[warp_nodes];
};

/// Points loaded at a time: as many as fit into 48 KiB of shared memory beside the tiles of four warps.
template<class Real, class Load>
__host__ __device__ constexpr int batch()
{
    constexpr std::size_t room = 49152 / scatter_warps - sizeof(WarpTile<Real>);
    int                   size = warp_size;
    while (sizeof(Real) * Load::width * static_cast<std::size_t>(size) > room) { size /= 2; }
    return size;
}

/// One lane of a warp: of every point's 27 nodes it has one, (column, row, layer). Along x its column is that node of
/// the point's three whose coordinate is `column` modulo 3, so that from one cell to the next two thirds of the lanes
/// keep their node, and with it the sums in their registers.
template<class Real, class Load>
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

    /// To the stencil of a cell of the layer, 0..15. All lanes together.
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
        if constexpr (Load::affine) { turn(point, momentum); }
        moving_.at[0] += weight * mass.at[0];
        for (int i = 0; i < 3; ++i) { moving_.at[1 + i] += weight * momentum[i]; }
        const Real stress[3][3] = {{normal.at[0], shear.at[1], shear.at[0]},
                                   {shear.at[1], normal.at[1], normal.at[3]},
                                   {shear.at[0], normal.at[3], normal.at[2]}};
        for (int i = 0; i < 3; ++i)
        {
            for (int j = 0; j < 3; ++j) { force_.at[i] += slope[j] * stress[i][j]; }
            if constexpr (Load::force) { force_.at[i] += weight * point[brought_force + i]; }
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

    /// Adds the affine velocity's momentum at the lane's node, which is (offset, row, layer) - fraction from the point.
    __device__ void turn(const Real* point, Real* momentum) const
    {
        const Real x = Real(offset_) - point[brought_fraction], y = Real(row_) - point[brought_fraction + 1],
                   z       = Real(layer_) - point[brought_fraction + 2];
        const Real* affine = point + brought_affine;
        for (int i = 0; i < 3; ++i)
        {
            momentum[i] += x * affine[3 * i] + y * affine[3 * i + 1] + z * affine[3 * i + 2];
        }
    }

    WarpTile<Real>& tile_;
    bool            working_;
    int             column_, row_, layer_;
    int             offset_ = 0, node_ = -1;
    Quad<Real>      moving_{}, force_{};
};

/// One block a page. Each warp takes the points of its layer of cells in the order of the list, a batch at a time: a
/// lane loads a point into shared memory, then all lanes add every point, each to its own node. Plain additions in a
/// fixed order, no atomics.
template<class Real, class Load>
struct ScatterPage
{
    static constexpr int points_a_batch = batch<Real, Load>();
    static constexpr int quads          = Load::width / 4;

    using Tile = WarpTile<Real>;

    PointsView<Real> points;
    PagesView        pages;
    Real*            tiles;

    __device__ void operator()(std::int64_t page) const
    {
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
        NodeLane<Real, Load> node(lane, tile);

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
        const Stencil<Real> s =
            stencil_above<Real>(cell, points.position.get(i), 1, pages.inverse_spacing, pages.stencil_shift);
        const Real       mass     = points.mass[i];
        const Vec3<Real> velocity = points.velocity.get(i);
        const Real       scale    = -points.volume[i] * Real(pages.inverse_spacing);
        const Sym3<Real> stress   = scale * points.stress.get(i);
        brought[brought_mass]     = mass;
        for (int c = 0; c < 3; ++c)
        {
            brought[brought_mass + 1 + c] = mass * velocity[c];
            for (int n = 0; n < 3; ++n)
            {
                brought[brought_splines + 6 * c + 2 * n]     = s.weight[c][n];
                brought[brought_splines + 6 * c + 2 * n + 1] = s.slope[c][n];
            }
        }
        for (int c = 0; c < 6; ++c) { brought[brought_stress + c] = stress[c]; }
        if constexpr (Load::force) { stage_force(i, brought); }
        if constexpr (Load::affine) { stage_affine(i, s, mass, brought); }
    }

    __device__ void stage_force(std::int64_t i, Real* brought) const
    {
        const bool       touched = points.contact_force.data != nullptr;
        const Vec3<Real> force   = touched ? points.contact_force.get(i) : Vec3<Real>(Vec3<Real>::Zero());
        for (int c = 0; c < 3; ++c) { brought[brought_force + c] = force[c]; }
    }

    __device__ void stage_affine(std::int64_t i, const Stencil<Real>& s, Real mass, Real* brought) const
    {
        const Real lever = mass * static_cast<Real>(pages.spacing);
        for (int c = 0; c < 3; ++c) { brought[brought_fraction + c] = s.fraction[c]; }
        for (int c = 0; c < 9; ++c)
        {
            brought[brought_affine + c] = lever * points.affine.data[c * points.affine.stride + i];
        }
    }

    /// A thread sums a column of nodes over the warps that reach it, low to high: mass and momentum, or force.
    __device__ static void write(const Tile* tile, Real* out)
    {
        for (int item = threadIdx.x; item < 2 * layer_nodes; item += scatter_threads)
        {
            const int column = item % layer_nodes, x = column % tile_edge, y = column / tile_edge;
            if (item < layer_nodes)
            {
                write_column<4>(column, x, y, out, [&](int w, int n) { return tile[w].moving[n]; });
            }
            else
            {
                write_column<3>(column, x, y, out + 4 * tile_nodes, [&](int w, int n) { return tile[w].force[n]; });
            }
        }
    }

    template<int channels, class Value>
    __device__ static void write_column(int column, int x, int y, Real* out, Value value)
    {
        const int low = tile_slot(x, y, 0), high = tile_slot(x, y, page_edge), step = tile_slot(x, y, 1) - low;
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
            Real* to = out + (z < page_edge ? low + z * step : high + (z - page_edge) * step);
            for (int c = 0; c < channels; ++c) { to[c * tile_nodes] = sum.at[c]; }
        }
    }
};

/// Sums of a page with few points: node (x, y, z) at x + row * y + layer * z. With these pitches 32 neighbouring cells,
/// each at the same one of its nodes, touch 32 banks.
constexpr int sparse_row   = 8;
constexpr int sparse_layer = 52;
constexpr int sparse_nodes = 5 * sparse_layer + 6 * sparse_row;

/// A warp a page, a lane a point, no two points of one cell at a time: in each of 27 rounds every lane adds to another
/// node. First the first points of all cells, then the second ones, and so on.
template<class Real, class Load>
struct ScatterSparsePage
{
    using Tile = Real[node_channels][sparse_nodes];

    PointsView<Real> points;
    PagesView        pages;
    Real*            tiles;

    __device__ void operator()(std::int64_t page) const
    {
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

    /// Lists the points that are number `turn` in their cell, in the order of cells; gives how many.
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

    /// One point, or none (-1); all lanes together.
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
            s    = stencil_above<Real>(node_at(low, place), points.position.get(i), pages.inverse_spacing,
                                    pages.inverse_spacing, pages.stencil_shift);
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

    /// Three nodes along x. What they share is formed once.
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
            if (Load::affine)
            {
                value[1 + k] += plane * spacing *
                                ((Real(b) - s.fraction[1]) * load.per_offset[1][1 + k] +
                                 (Real(c) - s.fraction[2]) * load.per_offset[2][1 + k]);
            }
            value[4 + k] = by_y * load.per_slope[1][4 + k] + by_z * load.per_slope[2][4 + k];
            if (Load::force) { value[4 + k] += plane * load.value[4 + k]; }
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
                if (Load::affine)
                {
                    momentum += plane * spacing * (Real(a) - s.fraction[0]) * load.per_offset[0][1 + k];
                }
                tile[1 + k][row + a] += weight * momentum;
                tile[4 + k][row + a] += weight * value[4 + k] + slope * by_x[k];
            }
        }
    }

    /// A lane writes a column of nodes of one channel at a time.
    __device__ static void write(int lane, const Tile& tile, Real* out)
    {
        __syncwarp();
        for (int item = lane; item < node_channels * layer_nodes; item += warp_size)
        {
            const int   channel = item / layer_nodes, x = item % tile_edge, y = item % layer_nodes / tile_edge;
            const int   low = tile_slot(x, y, 0), high = tile_slot(x, y, page_edge), step = tile_slot(x, y, 1) - low;
            const Real* column = tile[channel] + x + sparse_row * y;
            Real*       to     = out + channel * tile_nodes;
            for (int z = 0; z < page_edge; ++z) { to[low + z * step] = column[z * sparse_layer]; }
            for (int z = page_edge; z < tile_edge; ++z)
            {
                to[high + (z - page_edge) * step] = column[z * sparse_layer];
            }
        }
    }
};

/// Pages with fewer points than this on average are sparse.
constexpr std::int64_t full_page = 128;

} // namespace

template<class Real>
void scatter(const Gpu& gpu, const PointsView<Real>& points, const PagesView& pages, Real* tiles)
{
    const auto with_load = [&](auto load)
    {
        using Load = decltype(load);
        if (points.count < full_page * pages.point_pages)
        {
            for_each_block<warp_size>(gpu, "scatter", pages.point_pages,
                                      ScatterSparsePage<Real, Load>{points, pages, tiles});
        }
        else
        {
            for_each_block<scatter_threads, 8>(gpu, "scatter", pages.point_pages,
                                               ScatterPage<Real, Load>{points, pages, tiles});
        }
    };
    if (points.affine.data != nullptr) { with_load(AffineLoad{}); }
    else if (points.contact_force.data != nullptr) { with_load(ContactLoad{}); }
    else { with_load(PlainLoad{}); }
}

template void scatter(const Gpu&, const PointsView<float>&, const PagesView&, float*);
template void scatter(const Gpu&, const PointsView<double>&, const PagesView&, double*);

} // namespace tread::mpm
