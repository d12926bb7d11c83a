#include "kernels/mpm/grid/grid.hpp"

#include <cuda_pipeline.h>

#include "backend/block_sum.cuh"
#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "kernels/mpm/grid/wall_step_kern.hpp"

namespace tread::mpm
{
namespace
{

constexpr int grid_warps   = 4;
constexpr int grid_threads = grid_warps * warp_size;
/// Number of blocks per multiprocessor; fp64 needs twice the registers.
template<class Real>
constexpr int grid_blocks = sizeof(Real) == 4 ? 8 : 4;

/// The two nodes of a lane, neighbours along x.
template<class Real>
using Pair = Pack<Real, 2>;

/// Updates the nodes of the pages: one warp per node page, two nodes per lane.
template<class Real>
struct UpdatePages
{
    PagesView             pages;
    WallPagesView<Real>   wall_pages;
    SharedPagesView<Real> shared_pages;
    const Real*           tiles;
    GridStep<Real>        step;
    Real*                 motion;
    double*               tallies;

    __device__ void operator()(std::int64_t block) const
    {
        const std::int64_t page = block * grid_warps + threadIdx.x / warp_size;
        if (page >= pages.node_pages) { return; }
        const int                   lane = static_cast<int>(threadIdx.x) % warp_size;
        __shared__ alignas(16) Real nodes[grid_warps][node_channels * tile_nodes];
        Real*                       parts     = nodes[threadIdx.x / warp_size];
        const std::int32_t          shared    = shared_pages.number(page);
        const bool                  has_tile  = lane < octants && shared < 0;
        const std::int32_t          tile      = has_tile ? pages.point_page_of[octants * page + lane] : -1;
        const std::int32_t          wall_page = wall_pages.number(page);
        double*                     row       = tallies + page * tally_width(grid_sums);
        const double                tallied   = lane < grid_sums ? row[lane] : 0;
        fetch_parts(tile, lane, parts);
        const bool     points = tile >= 0 && pages.first_point[tile] < pages.first_point[tile + 1];
        const unsigned filled = __ballot_sync(all_lanes, points);
        __pipeline_wait_prior(0);
        __syncwarp();
        Pair<Real> channels[node_channels] = {};
        sum_pairs(filled, lane, parts, channels);
        if (shared >= 0) { read_pairs(shared, lane, channels); }
        Real* out = motion + page * motion_channels * page_cells + 2 * lane;
        if (wall_page < 0) { update_free(channels, lane, out, tallied, row); }
        else { update_held(page, wall_page, channels, lane, out, tallied, row); }
    }

    /// Starts the asynchronous copy of the surrounding tiles' contributions to the page. Each octant is contiguous in
    /// memory and is stored in `parts` as in its tile. Lane `octant` has the tile's page. Whether that page has points
    /// is not yet known: if it has none, the copy is not used.
    __device__ void fetch_parts(std::int32_t tile_of_lane, int lane, Real* parts) const
    {
        constexpr int width = 16 / sizeof(Real), pieces = node_channels * tile_nodes / width;
#pragma unroll
        for (int first = 0; first < pieces; first += warp_size)
        {
            const int          at     = (first + lane) * width;
            const int          octant = octant_at(at);
            const std::int32_t page   = __shfl_sync(all_lanes, tile_of_lane, octant);
            if (first + lane >= pieces || page < 0) { continue; }
            __pipeline_memcpy_async(parts + at, tiles + std::int64_t(page) * node_channels * tile_nodes + at, 16);
        }
        __pipeline_commit();
    }

    /// Returns the octant in which a tile stores number `at`.
    __device__ static int octant_at(int at)
    {
        int octant = 0;
#pragma unroll
        for (int o = 1; o < octants; ++o) { octant += at >= octant_start(o); }
        return octant;
    }

    /// Sums the tiles for two nodes, like sum_tiles.
    __device__ static void sum_pairs(unsigned filled, int lane, const Real* parts, Pair<Real>* total)
    {
        const int x = 2 * (lane & 1), y = lane >> 1 & 3, z = lane >> 3;
#pragma unroll
        for (int octant = 0; octant < octants; ++octant)
        {
            if (x >= octant_edge(octant, 0) || y >= octant_edge(octant, 1) || z >= octant_edge(octant, 2)) { continue; }
            if ((filled >> octant & 1U) == 0) { continue; }
            const Real* part =
                parts + octant_start(octant) + x + octant_edge(octant, 0) * (y + octant_edge(octant, 1) * z);
#pragma unroll
            for (int c = 0; c < node_channels; ++c)
            {
                const auto two = *reinterpret_cast<const Pair<Real>*>(part + c * octant_nodes(octant));
                total[c].at[0] += two.at[0];
                total[c].at[1] += two.at[1];
            }
        }
    }

    /// Reads the totals of two nodes, like read_total.
    __device__ void read_pairs(std::int32_t shared, int lane, Pair<Real>* total) const
    {
        const Real* from = shared_pages.total + std::int64_t(shared) * node_page_values + 2 * lane;
#pragma unroll
        for (int c = 0; c < node_channels; ++c)
        {
            total[c] = *reinterpret_cast<const Pair<Real>*>(from + c * page_cells);
        }
    }

    __device__ void update_free(const Pair<Real>* channels, int lane, Real* out, double tallied, double* row) const
    {
        Real          sum[grid_sums] = {};
        NodeEnd<Real> node[2];
#pragma unroll
        for (int n = 0; n < 2; ++n) { node[n] = update_free_node(step, of_node(channels, n).at, sum); }
        write_pair(node, out);
        if (step.damping > 0) { tally_warp<grid_wall_loss>(sum, lane, tallied, row); }
        else { tally_warp<grid_damped>(sum, lane, tallied, row); }
    }

    __device__ void update_held(std::int64_t page, std::int32_t wall_page, const Pair<Real>* channels, int lane,
                                Real* out, double tallied, double* row) const
    {
        Real            sum[grid_sums] = {};
        NodeEnd<Real>   node[2];
        const Index3    at         = page_coordinates(pages.node_page_key[page]);
        WallNode<Real>* wall_nodes = wall_pages.node + std::int64_t(wall_page) * page_cells + 2 * lane;
#pragma unroll
        for (int n = 0; n < 2; ++n)
        {
            node[n] = update_node(step, node_at(at, 2 * lane + n), of_node(channels, n).at, wall_nodes[n], sum);
        }
        write_pair(node, out);
        tally_warp<grid_sums>(sum, lane, tallied, row);
    }

    __device__ static Pack<Real, 8> of_node(const Pair<Real>* channels, int n)
    {
        Pack<Real, 8> node;
        for (int c = 0; c < node_channels; ++c) { node.at[c] = channels[c].at[n]; }
        return node;
    }

    __device__ static void write_pair(const NodeEnd<Real>* node, Real* out)
    {
        for (int c = 0; c < 3; ++c)
        {
            *reinterpret_cast<Pair<Real>*>(out + c * page_cells)       = {{node[0].velocity[c], node[1].velocity[c]}};
            *reinterpret_cast<Pair<Real>*>(out + (3 + c) * page_cells) = {{node[0].change[c], node[1].change[c]}};
        }
    }

    /// Adds the first `count` sums to the tally; the others are zero. `tallied`: the tally of the lane's sum before.
    template<int count>
    __device__ static void tally_warp(const Real* sum, int lane, double tallied, double* row)
    {
        const Real   all   = warp_combine<count>(sum, AddValues{});
        const Real   own   = __shfl_sync(all_lanes, all, lane * lanes_a_slot<count> % warp_size);
        const double value = lane < count ? static_cast<double>(own) : 0;
        if (lane >= grid_sums) { return; }
        row[lane]             = tallied + value;
        row[grid_sums + lane] = value;
    }
};

constexpr int wall_threads = 64;

/// Updates a wall page with one block.
template<class Real>
struct UpdateWallPage
{
    PagesView           pages;
    WallPagesView<Real> wall_pages;
    GridStep<Real>      step;
    Real*               motion;
    double*             tallies;

    __device__ void operator()(std::int64_t number) const
    {
        __shared__ WallNode<Real> nodes[wall_region_nodes];
        __shared__ double         shared[wall_threads / warp_size * grid_sums];
        const std::int64_t        page           = wall_pages.page[number];
        const Index3              at             = page_coordinates(pages.node_page_key[page]);
        const WallRegion          region         = wall_region(step.walls, at);
        Real                      sum[grid_sums] = {};
        const int                 first          = static_cast<int>(threadIdx.x);
        for (int item = first; item < region.nodes; item += wall_threads)
        {
            nodes[item] = wall_node(wall_pages, number, region_node(region, item));
        }
#pragma unroll
        for (int axis = 0; axis < 3; ++axis)
        {
            if (!region.paired[axis]) { continue; }
            __syncthreads();
#pragma unroll
            for (int end = 0; end < 2; ++end)
            {
                const int plane = wall_plane(step.walls, at, region, axis, end);
                if (plane == no_plane) { continue; }
                for (int item = first; item < region.nodes >> region.bits[axis]; item += wall_threads)
                {
                    hold_group(step.walls, region, axis, end, plane, item, nodes, sum);
                }
            }
        }
        __syncthreads();
        if (first < page_cells)
        {
            Real* here = motion + page * motion_channels * page_cells + first;
            finish_wall_node(step, nodes[region_item(region, first)], here, sum);
        }
        double* row = tallies + page * tally_width(grid_sums);
        block_sum<wall_threads, grid_sums>(sum, shared,
                                           [=](int s, double value) { add_to_same_step(row, grid_sums, s, value); });
    }
};

} // namespace

template<class Exec, class Real>
void update_grid(const Exec& gpu, const PagesView& pages, const WallPagesView<Real>& wall_pages,
                 const SharedPagesView<Real>& shared_pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                 double* tallies)
{
    for_each_block<grid_threads, grid_blocks<Real>>(
        gpu, "update grid", (pages.node_pages + grid_warps - 1) / grid_warps,
        UpdatePages<Real>{pages, wall_pages, shared_pages, tiles, step, motion, tallies});
}

template<class Exec, class Real>
void update_walls(const Exec& gpu, const PagesView& pages, const WallPagesView<Real>& wall_pages,
                  const GridStep<Real>& step, Real* motion, double* tallies)
{
    for_each_block<wall_threads>(gpu, "update walls", wall_pages.count,
                                 UpdateWallPage<Real>{pages, wall_pages, step, motion, tallies});
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void update_grid(const Exec&, const PagesView&, const WallPagesView<Real>&, const SharedPagesView<Real>&, \
                              const Real*, const GridStep<Real>&, Real*, double*);                                     \
    template void update_walls(const Exec&, const PagesView&, const WallPagesView<Real>&, const GridStep<Real>&,       \
                               Real*, double*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
