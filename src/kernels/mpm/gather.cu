#include "kernels/mpm/gather.hpp"

#include "backend/block_sum.cuh"
#include "backend/launch.cuh"
#include "backend/pack.hpp"
#include "kernels/mpm/gather_kern.hpp"

namespace tread::mpm
{
namespace
{

/// Measured on an H200: the kernel waits, and more warps hide more of it than the registers that they spill cost. fp32,
/// 1e7 points at rest, 8 a cell, points/s for 512, 640, 768, 896 threads: AFLIP 6.7e9, 6.9e9, 6.1e9, 4.9e9; FLIP 7.9e9,
/// 8.4e9, 8.2e9, 8.1e9.
template<class Real>
constexpr int threads_an_sm = sizeof(Real) == 4 ? 640 : 512;

/// Fewer pages than this leave multiprocessors idle unless each page has many threads.
constexpr std::int64_t few_pages = 1024;

/// Where shared memory keeps tile node (x, y, z): with this pitch the 16 cells of a layer, each at the same one of its
/// nodes, touch all banks.
constexpr int gather_row   = 12;
constexpr int gather_layer = gather_row * tile_edge;
constexpr int gather_nodes = gather_layer * tile_edge;

__device__ int gather_slot(int x, int y, int z) { return x + gather_row * y + gather_layer * z; }

/// One tile node in shared memory, aligned so that its channels come in pairs.
template<class Real>
struct alignas(2 * sizeof(Real)) MotionNode
{
    Real channel[motion_channels];
};

/// Brings the motion of a page's tile into shared memory: a thread a row of nodes, or several with some channels each.
template<int threads, class Real>
__device__ void load_tile(const Real* motion, const std::int32_t* node_page, MotionNode<Real>* tile)
{
    constexpr int rows = tile_edge * tile_edge, beyond = tile_edge - page_edge;
    constexpr int teams = threads / rows < motion_channels ? threads / rows : motion_channels;
    const int     y = static_cast<int>(threadIdx.x) % tile_edge, z = static_cast<int>(threadIdx.x) % rows / tile_edge;
    const int     team = static_cast<int>(threadIdx.x) / rows;
    if (team >= teams) { return; }
    const std::int32_t* page = node_page + (y / page_edge << 1 | z / page_edge << 2);
    const Real*         here = motion + page_edge * (y % page_edge + page_edge * (z % page_edge));
    const Real*         low  = here + std::int64_t(page[0]) * motion_channels * page_cells;
    const Real*         high = here + std::int64_t(page[1]) * motion_channels * page_cells;
    MotionNode<Real>*   node = tile + gather_slot(0, y, z);
#pragma unroll
    for (int c = team; c < motion_channels; c += teams)
    {
        const auto four = *reinterpret_cast<const Pack<Real, page_edge>*>(low + c * page_cells);
        const auto two  = *reinterpret_cast<const Pack<Real, beyond>*>(high + c * page_cells);
        for (int x = 0; x < page_edge; ++x) { node[x].channel[c] = four.at[x]; }
        for (int x = 0; x < beyond; ++x) { node[page_edge + x].channel[c] = two.at[x]; }
    }
}

/// The motion of a stencil's nodes, from shared memory.
template<class Real>
struct NodesOfTile
{
    const MotionNode<Real>* lowest;

    __device__ NodeMotion<Real, 3> operator()(int a, int b, int c) const
    {
        const MotionNode<Real> node = lowest[gather_slot(a, b, c)];
        return {{node.channel[0], node.channel[1], node.channel[2]},
                {node.channel[3], node.channel[4], node.channel[5]}};
    }
};

/// One block a page: its tile in shared memory, its points dealt to the threads in order.
template<int threads, class Real, class Moment>
struct GatherPage
{
    PointsView<Real> points;
    PagesView        pages;
    const Real*      motion;
    GatherStep<Real> step;
    MovesView        moves;
    double*          tallies;
    double*          peaks;

    __device__ void operator()(std::int64_t page) const
    {
        if (pages.first_point[page] == pages.first_point[page + 1])
        {
            clear(page);
            return;
        }
        __shared__ MotionNode<Real> tile[gather_nodes];
        __shared__ double           shared_sums[threads / 32 * point_sums];
        __shared__ double           shared_peaks[threads / 32 * point_peaks];
        __shared__ std::int32_t count[move_counts];
        if (threadIdx.x < move_counts) { count[threadIdx.x] = 0; }
        load_tile<threads>(motion, pages.node_page_of + 8 * page, tile);
        __syncthreads();
        Real               sum[point_sums] = {}, peak[point_peaks] = {}; // of a few points
        const Index3       low     = page_coordinates(pages.point_page_key[page]);
        const Real         spacing = static_cast<Real>(pages.spacing);
        const std::int64_t end     = pages.first_point[page + 1];
        for (std::int64_t at = pages.first_point[page] + threadIdx.x; at < end; at += threads)
        {
            const std::int64_t      i       = pages.point_at[at];
            const Index3            cell    = node_at(low, pages.place_at[at]);
            const auto              stencil = stencil_above<Real>(cell, points.position.get(i), pages.inverse_spacing,
                                                     pages.inverse_spacing, pages.stencil_shift);
            const Index3            base    = stencil.base;
            const NodesOfTile<Real> nodes{tile + gather_slot(base.x & 3, base.y & 3, base.z & 3)};
            const auto              seen = see(stencil, spacing, nodes, Moment{});
            const Move              move = update_point(points, i, seen, stencil.base, pages, page, step, sum, peak);
            moves.to[at]                 = packed(move);
            if (move.stir != Stir::none) { count_move(move, count); }
        }
        double* row  = tallies + page * tally_width(point_sums);
        double* most = peaks + page * point_peaks;
        block_sum<threads, point_sums>(sum, shared_sums, [=](int s, double value) { book(row, point_sums, s, value); });
        block_largest<threads, point_peaks>(peak, shared_peaks,
                                            [=](int p, double value) { most[p] = fmax(most[p], value); });
        if (threadIdx.x < move_counts) { moves.count[page * move_counts + threadIdx.x] = count[threadIdx.x]; }
        if (threadIdx.x == 0 && count[stirred_points] > 0) { *moves.stirred_in = moves.step; }
    }

    /// Nothing happens on a page without points.
    __device__ void clear(std::int64_t page) const
    {
        if (threadIdx.x < point_sums) { tallies[page * tally_width(point_sums) + point_sums + threadIdx.x] = 0; }
        if (threadIdx.x < move_counts) { moves.count[page * move_counts + threadIdx.x] = 0; }
    }

    /// Integers: the order of the additions changes nothing.
    __device__ static void count_move(const Move& move, std::int32_t* count)
    {
        atomicAdd(count + stirred_points, 1);
        if (move.direction != own_page) { atomicAdd(count + move.direction, 1); }
    }
};

} // namespace

template<class Real>
void gather(const Gpu& gpu, const PointsView<Real>& points, const PagesView& pages, const Real* motion,
            const GatherStep<Real>& step, const MovesView& moves, double* tallies, double* peaks)
{
    const auto launch = [&](auto threads, auto moment)
    {
        for_each_block<threads, threads_an_sm<Real> / threads>(
            gpu, "gather", pages.point_pages,
            GatherPage<threads, Real, decltype(moment)>{points, pages, motion, step, moves, tallies, peaks});
    };
    const auto with_threads = [&](auto threads)
    {
        if (points.affine.data != nullptr) { launch(threads, WithMoment{}); }
        else { launch(threads, WithoutMoment{}); }
    };
    if (pages.point_pages < few_pages) { with_threads(std::integral_constant<int, 256>{}); }
    else { with_threads(std::integral_constant<int, 64>{}); }
}

template void gather(const Gpu&, const PointsView<float>&, const PagesView&, const float*, const GatherStep<float>&,
                     const MovesView&, double*, double*);
template void gather(const Gpu&, const PointsView<double>&, const PagesView&, const double*, const GatherStep<double>&,
                     const MovesView&, double*, double*);

} // namespace tread::mpm
