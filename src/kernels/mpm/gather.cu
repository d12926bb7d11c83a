#include "kernels/mpm/gather.hpp"

#include <cuda_pipeline.h>

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
constexpr int threads_an_sm = 512;

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

/// Where points wait for their threads: what read_point reads, on its way from device memory while the point before is
/// updated. A thread uses its own column alone.
template<int threads, class Real>
class Waiting
{
public:
    __device__ void fetch(const PointsView<Real>& points, std::int64_t i)
    {
        const int t = static_cast<int>(threadIdx.x);
        for (int c = 0; c < 3; ++c)
        {
            bring(position_[c][t], points.position, c, i);
            bring(velocity_[c][t], points.velocity, c, i);
        }
        for (int c = 0; c < 6; ++c) { bring(stress_[c][t], points.stress, c, i); }
        bring(mass_[t], points.mass, i);
        bring(volume_[t], points.volume, i);
        bring(volume_ratio_[t], points.volume_ratio, i);
        if (points.plastic_shear != nullptr)
        {
            bring(plastic_shear_[t], points.plastic_shear, i);
            bring(volume_gap_[t], points.volume_gap, i);
        }
    }

    __device__ PointState<Real> take(const PointsView<Real>& points, std::uint8_t material) const
    {
        const int        t       = static_cast<int>(threadIdx.x);
        const bool       plastic = points.plastic_shear != nullptr;
        PointState<Real> point;
        for (int c = 0; c < 3; ++c)
        {
            point.position[c] = position_[c][t];
            point.velocity[c] = velocity_[c][t];
        }
        for (int c = 0; c < 6; ++c) { point.stress[c] = stress_[c][t]; }
        point.mass          = mass_[t];
        point.volume        = volume_[t];
        point.volume_ratio  = volume_ratio_[t];
        point.plastic_shear = plastic ? plastic_shear_[t] : Real(0);
        point.volume_gap    = plastic ? volume_gap_[t] : Real(0);
        point.material      = material;
        return point;
    }

private:
    template<class T>
    __device__ static void bring(T& to, const T* from, std::int64_t i)
    {
        __pipeline_memcpy_async(&to, from + i, sizeof(T));
    }

    template<class T, int components>
    __device__ static void bring(T& to, const Planes<T, components>& from, int component, std::int64_t i)
    {
        __pipeline_memcpy_async(&to, from.data + component * from.stride + i, sizeof(T));
    }

    double position_[3][threads];
    Real   velocity_[3][threads], stress_[6][threads];
    Real   mass_[threads], volume_[threads], volume_ratio_[threads], plastic_shear_[threads], volume_gap_[threads];
};

/// One point of the list.
struct Listed
{
    std::int32_t point;
    std::uint8_t place;
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
        const std::int64_t end = pages.first_point[page + 1];
        std::int64_t       at  = pages.first_point[page];
        if (at == end)
        {
            clear(page);
            return;
        }
        __shared__ MotionNode<Real> tile[gather_nodes];
        __shared__ Waiting<threads, Real> waiting;
        __shared__ double                 shared_sums[threads / 32 * point_sums];
        __shared__ double                 shared_peaks[threads / 32 * point_peaks];
        __shared__ std::int32_t count[move_counts];
        if (threadIdx.x < move_counts) { count[threadIdx.x] = 0; }
        at += threadIdx.x;
        Listed       next     = listed(at, end);
        std::uint8_t material = fetch(next, at < end, waiting);
        Listed       later    = listed(at + threads, end);
        load_tile<threads>(motion, pages.node_page_of + 8 * page, tile);
        __syncthreads();
        Real         sum[point_sums] = {}, peak[point_peaks] = {}; // of a few points
        const Index3 low     = page_coordinates(pages.point_page_key[page]);
        const Real   spacing = static_cast<Real>(pages.spacing);
        for (; at < end; at += threads)
        {
            __pipeline_wait_prior(0);
            const PointState<Real> point = waiting.take(points, material);
            const Listed           now   = next;
            next                         = later;
            material                     = fetch(next, at + threads < end, waiting);
            later                        = listed(at + 2 * threads, end);
            const Index3 cell            = node_at(low, now.place);
            const auto stencil = stencil_above<Real>(cell, point.position, pages.inverse_spacing, pages.inverse_spacing,
                                                     pages.stencil_shift);
            const NodesOfTile<Real> nodes{tile + gather_slot(cell.x & 3, cell.y & 3, cell.z & 3)};
            const auto              seen = see(stencil, spacing, nodes, Moment{});
            const Move move = update_point(points, now.point, point, seen, stencil.base, pages, page, step, sum, peak);
            moves.to[at]    = packed(move);
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

    __device__ Listed listed(std::int64_t at, std::int64_t end) const
    {
        if (at >= end) { return {}; }
        return {pages.point_at[at], pages.place_at[at]};
    }

    /// Gives the point's material.
    __device__ std::uint8_t fetch(const Listed& next, bool any, Waiting<threads, Real>& waiting) const
    {
        if (!any) { return 0; }
        waiting.fetch(points, next.point);
        __pipeline_commit();
        return points.material[next.point];
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
    constexpr int many_threads = sizeof(Real) == 4 ? 256 : 128;
    if (pages.point_pages < few_pages) { with_threads(std::integral_constant<int, many_threads>{}); }
    else { with_threads(std::integral_constant<int, 64>{}); }
}

template void gather(const Gpu&, const PointsView<float>&, const PagesView&, const float*, const GatherStep<float>&,
                     const MovesView&, double*, double*);
template void gather(const Gpu&, const PointsView<double>&, const PagesView&, const double*, const GatherStep<double>&,
                     const MovesView&, double*, double*);

} // namespace tread::mpm
