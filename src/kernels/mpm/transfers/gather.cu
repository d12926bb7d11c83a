#include "kernels/mpm/transfers/gather.hpp"

#include <algorithm>
#include <array>

#include <cuda_pipeline.h>

#include "backend/block_sum.cuh"
#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "backend/pack.hpp"
#include "kernels/mpm/transfers/gather_kern.hpp"

namespace tread::mpm
{
namespace
{

/// Number of threads per multiprocessor, which limits the registers: with more threads the kernel spills.
template<class Real>
constexpr int threads_an_sm = sizeof(Real) == 4 ? 512 : 384;

/// Number of pages below which multiprocessors are idle unless each page has many threads.
constexpr std::int64_t few_pages = 1024;

/// Mean number of points per page below which a page has a single warp, which needs no block synchronisation.
constexpr std::int64_t gather_full_page = 128;

/// Layout of tile node (x, y, z) in shared memory: with this pitch, the 16 cells of a layer, each reading the same node
/// of its stencil, access different banks.
constexpr int gather_row  = 40;
constexpr int gather_size = gather_row * tile_edge * tile_edge;

__device__ int gather_slot(int x, int y, int z) { return motion_channels * x + gather_row * (y + tile_edge * z); }

/// Two channels of a node.
template<class Real>
using TwoChannels = Pack<Real, 2>;

/// Two channels of a row of tile nodes.
template<class Real>
struct RowPair
{
    Pack<Real, page_edge>             low[2];
    Pack<Real, tile_edge - page_edge> high[2];
};

/// Copies the motion of a page's tile into shared memory: all loads of a thread first, then its stores.
template<int threads, class Real>
__device__ void load_tile(const Real* motion, const std::int32_t* node_page, Real* tile)
{
    constexpr int pairs = motion_channels / 2, items = pairs * tile_edge * tile_edge;
    constexpr int turns = (items + threads - 1) / threads;
    RowPair<Real> part[turns];
    const auto    for_each_turn = [](auto visit)
    {
#pragma unroll
        for (int turn = 0; turn < turns; ++turn)
        {
            const int item = static_cast<int>(threadIdx.x) + turn * threads;
            if (item < items) { visit(turn, item % pairs * 2, item / pairs % tile_edge, item / (pairs * tile_edge)); }
        }
    };
    for_each_turn(
        [&](int turn, int channel, int y, int z)
        {
            const std::int32_t* page = node_page + (y / page_edge << 1 | z / page_edge << 2);
            const int   place        = channel * page_cells + page_edge * (y % page_edge + page_edge * (z % page_edge));
            const Real* low          = motion + std::int64_t(page[0]) * motion_channels * page_cells + place;
            const Real* high         = motion + std::int64_t(page[1]) * motion_channels * page_cells + place;
            for (int c = 0; c < 2; ++c)
            {
                part[turn].low[c]  = *reinterpret_cast<const Pack<Real, page_edge>*>(low + c * page_cells);
                part[turn].high[c] = *reinterpret_cast<const Pack<Real, tile_edge - page_edge>*>(high + c * page_cells);
            }
        });
    for_each_turn(
        [&](int turn, int channel, int y, int z)
        {
            Real* row = tile + gather_slot(0, y, z) + channel;
            for (int x = 0; x < tile_edge; ++x)
            {
                *reinterpret_cast<TwoChannels<Real>*>(row + motion_channels * x) =
                    x < page_edge ? TwoChannels<Real>{{part[turn].low[0].at[x], part[turn].low[1].at[x]}}
                                  : TwoChannels<Real>{
                                        {part[turn].high[0].at[x - page_edge], part[turn].high[1].at[x - page_edge]}};
            }
        });
}

/// Reads one component of the motion of a stencil's nodes from shared memory.
template<class Real>
struct ComponentOfTile
{
    const Real* lowest;
    int         component;

    __device__ NodeMotion<std::array<Real, 1>> operator()(int a, int b, int c) const
    {
        const Real* node = lowest + gather_slot(a, b, c);
        return {{{node[component]}}, {{node[3 + component]}}};
    }
};

/// Interpolates the motion component by component, so that the sums of one at a time are in registers.
template<class Real, class Moment>
__device__ Seen<Real> see(const Stencil<Real>& s, Real spacing, const Real* lowest, Moment)
{
    Seen<Real> seen{};
#pragma unroll
    for (int i = 0; i < 3; ++i)
    {
        set_seen(seen, i, sum_motion(s, ComponentOfTile<Real>{lowest, i}, Moment{}), 0, s, spacing, Moment{});
    }
    return seen;
}

/// Prefetch buffer in shared memory: the data of the next point are copied from device memory while the present point
/// is updated. A thread uses only its own column.
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

/// Gathers one page per block: its tile is in shared memory, its points are assigned to the threads in order.
template<int threads, class Real, class Moment>
struct GatherPage
{
    PointsView<Real> points;
    PagesView        pages;
    PageList         list;
    const Real*      motion;
    GatherStep<Real> step;
    MovesView        moves;
    double*          tallies;
    double*          peaks;

    __device__ void operator()(std::int64_t block) const
    {
        const std::int64_t page = list.at(block);
        const std::int64_t end  = pages.first_point[page + 1];
        std::int64_t       at   = pages.first_point[page];
        if (at == end)
        {
            clear(page);
            return;
        }
        __shared__ alignas(16) Real tile[gather_size];
        __shared__ Waiting<threads, Real> waiting;
        __shared__ double                 shared_sums[threads / 32 * point_sums];
        __shared__ double                 shared_peaks[threads / 32 * point_peaks];
        __shared__ std::int32_t count[move_counts];
        if (threadIdx.x < move_counts) { count[threadIdx.x] = 0; }
        double*      row     = tallies + page * tally_width(point_sums);
        double*      most    = peaks + page * point_peaks;
        const double tallied = threadIdx.x < point_sums ? row[threadIdx.x] : 0;
        const double before  = threadIdx.x < point_peaks ? most[threadIdx.x] : 0;
        at += threadIdx.x;
        Listed       next     = listed(at, end);
        std::uint8_t material = fetch(next, at < end, waiting);
        Listed       later    = listed(at + threads, end);
        load_tile<threads>(motion, pages.node_page_of + 8 * page, tile);
        __syncthreads();
        Real         sum[point_sums] = {}, peak[point_peaks] = {}; // over the few points of one thread
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
            const auto   stencil         = stencil_above<Real>(cell, point.position, pages.inverse_spacing, pages);
            const Real*  lowest          = tile + gather_slot(cell.x & 3, cell.y & 3, cell.z & 3);
            const auto   seen            = see(stencil, spacing, lowest, Moment{});
            const Move move = update_point(points, now.point, point, seen, stencil.base, pages, page, step, sum, peak);
            moves.to[at]    = packed(move);
            if (move.cell_change != CellChange::none) { count_move(move, count); }
        }
        block_sum<threads, point_sums>(sum, shared_sums,
                                       [=](int s, double value)
                                       {
                                           row[s]              = tallied + value;
                                           row[point_sums + s] = value;
                                       });
        block_largest<threads, point_peaks>(peak, shared_peaks,
                                            [=](int p, double value) { most[p] = fmax(before, value); });
        if (threadIdx.x < move_counts) { moves.count[page * move_counts + threadIdx.x] = count[threadIdx.x]; }
        if (threadIdx.x == 0 && count[changed_points] > 0) { *moves.changed_in = moves.step; }
    }

    __device__ Listed listed(std::int64_t at, std::int64_t end) const
    {
        if (at >= end) { return {}; }
        return {pages.point_at[at], pages.place_at[at]};
    }

    /// Prefetches a point and returns its material.
    __device__ std::uint8_t fetch(const Listed& next, bool any, Waiting<threads, Real>& waiting) const
    {
        if (!any) { return 0; }
        waiting.fetch(points, next.point);
        __pipeline_commit();
        return points.material[next.point];
    }

    /// Clears the results of a page without points.
    __device__ void clear(std::int64_t page) const
    {
        if (threadIdx.x < point_sums) { tallies[page * tally_width(point_sums) + point_sums + threadIdx.x] = 0; }
        if (threadIdx.x < move_counts) { moves.count[page * move_counts + threadIdx.x] = 0; }
    }

    /// Counts a move; integer sums do not depend on the order.
    __device__ static void count_move(const Move& move, std::int32_t* count)
    {
        atomicAdd(count + changed_points, 1);
        if (move.direction != own_page) { atomicAdd(count + move.direction, 1); }
    }
};

} // namespace

template<class Exec, class Real>
void gather(const Exec& gpu, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
            const Real* motion, const GatherStep<Real>& step, const MovesView& moves, double* tallies, double* peaks)
{
    const auto launch = [&](auto threads, auto moment)
    {
        for_each_block<threads, std::max(1, threads_an_sm<Real> / threads)>(
            gpu, "gather", list.count,
            GatherPage<threads, Real, decltype(moment)>{points, pages, list, motion, step, moves, tallies, peaks});
    };
    const auto with_threads = [&](auto threads)
    {
        if (points.affine.data != nullptr) { launch(threads, WithMoment{}); }
        else { launch(threads, WithoutMoment{}); }
    };
    constexpr int many_threads = sizeof(Real) == 4 ? 256 : 128;
    if (list.count < few_pages) { with_threads(std::integral_constant<int, many_threads>{}); }
    else if (points.count < gather_full_page * pages.point_pages)
    {
        with_threads(std::integral_constant<int, warp_size>{});
    }
    else { with_threads(std::integral_constant<int, 64>{}); }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void gather(const Exec&, const PointsView<Real>&, const PagesView&, const PageList&, const Real*,         \
                         const GatherStep<Real>&, const MovesView&, double*, double*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
