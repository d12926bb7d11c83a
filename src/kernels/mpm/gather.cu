#include "kernels/mpm/gather.hpp"

#include "backend/block_sum.cuh"
#include "backend/launch.cuh"
#include "kernels/mpm/gather_kern.hpp"

namespace tread::mpm
{
namespace
{

constexpr int gather_threads = 64;

/// Measured on an H200: the kernel waits for memory, and more warps hide more of it than the spilled registers cost
/// (fp32, 4e6 points, 8 a cell: 8.6e9 points/s with 8 blocks, 10.5e9 with 12; fp64: 6.0e9 with 8, 4.1e9 with 12).
template<class Real>
constexpr int blocks_an_sm = sizeof(Real) == 4 ? 12 : 8;

/// Without APIC nothing reads the moment.
struct WithoutMoment
{
};
struct WithMoment
{
};

/// One tile node in shared memory, aligned so that its channels come in pairs.
template<class Real>
struct alignas(2 * sizeof(Real)) MotionNode
{
    Real channel[motion_channels];
};

/// Partial sums of the velocity over rows and layers of nodes, and of its products with slopes and offsets.
template<class Real>
struct Partial
{
    Real velocity[3], by_x[3], by_y[3], by_z[3], change[3];
    Real at_x[3], at_y[3], at_z[3];
};

/// The sums of see(), one axis after the other: a third of the operations.
template<class Real, class Moment>
__device__ Seen<Real> see_tile(const Stencil<Real>& s, Real spacing, const MotionNode<Real>* tile, Moment)
{
    constexpr bool moment = std::is_same_v<Moment, WithMoment>;
    Partial<Real>  all{};
    const int      base = tile_base(s.base);
#pragma unroll
    for (int c = 0; c < 3; ++c)
    {
        Partial<Real> layer{};
#pragma unroll
        for (int b = 0; b < 3; ++b)
        {
            Partial<Real> row{};
#pragma unroll
            for (int a = 0; a < 3; ++a)
            {
                const MotionNode<Real> node   = tile[base + tile_offset(a, b, c)];
                const Real             weight = s.weight[0][a], slope = s.slope[0][a];
#pragma unroll
                for (int i = 0; i < 3; ++i)
                {
                    row.velocity[i] += weight * node.channel[i];
                    row.by_x[i] += slope * node.channel[i];
                    row.change[i] += weight * node.channel[3 + i];
                    if (moment) { row.at_x[i] += (Real(a) - s.fraction[0]) * weight * node.channel[i]; }
                }
            }
            const Real weight = s.weight[1][b], slope = s.slope[1][b];
#pragma unroll
            for (int i = 0; i < 3; ++i)
            {
                layer.velocity[i] += weight * row.velocity[i];
                layer.by_x[i] += weight * row.by_x[i];
                layer.by_y[i] += slope * row.velocity[i];
                layer.change[i] += weight * row.change[i];
                if (moment)
                {
                    layer.at_x[i] += weight * row.at_x[i];
                    layer.at_y[i] += (Real(b) - s.fraction[1]) * weight * row.velocity[i];
                }
            }
        }
        const Real weight = s.weight[2][c], slope = s.slope[2][c];
#pragma unroll
        for (int i = 0; i < 3; ++i)
        {
            all.velocity[i] += weight * layer.velocity[i];
            all.by_x[i] += weight * layer.by_x[i];
            all.by_y[i] += weight * layer.by_y[i];
            all.by_z[i] += slope * layer.velocity[i];
            all.change[i] += weight * layer.change[i];
            if (moment)
            {
                all.at_x[i] += weight * layer.at_x[i];
                all.at_y[i] += weight * layer.at_y[i];
                all.at_z[i] += (Real(c) - s.fraction[2]) * weight * layer.velocity[i];
            }
        }
    }
    Seen<Real> seen{};
    for (int i = 0; i < 3; ++i)
    {
        seen.velocity[i] = all.velocity[i];
        seen.change[i]   = all.change[i];
        seen.gradient.row(i) << all.by_x[i], all.by_y[i], all.by_z[i];
        if (moment) { seen.moment.row(i) << spacing * all.at_x[i], spacing * all.at_y[i], spacing * all.at_z[i]; }
    }
    return seen;
}

/// One block a page: its tile in shared memory, its points dealt to the threads in order.
template<class Real, class Moment>
struct GatherPage
{
    PointsView<Real> points;
    PagesView        pages;
    const Real*      motion;
    GatherStep<Real> step;
    double*          sums;
    double*          peaks;

    __device__ void operator()(std::int64_t page) const
    {
        __shared__ MotionNode<Real> tile[tile_nodes];
        __shared__ double           shared_sums[gather_threads / 32 * point_sums];
        __shared__ double           shared_peaks[gather_threads / 32 * point_peaks];
        for (int node = threadIdx.x; node < tile_nodes; node += gather_threads)
        {
            const Real* source = tile_source(motion, pages.node_page_of + 8 * page, node);
            for (int c = 0; c < motion_channels; ++c) { tile[node].channel[c] = source[c * page_cells]; }
        }
        __syncthreads();
        double             sum[point_sums] = {}, peak[point_peaks] = {};
        const Real         spacing = static_cast<Real>(pages.spacing);
        const std::int64_t end     = pages.first_point[page + 1];
        for (std::int64_t i = pages.first_point[page] + threadIdx.x; i < end; i += gather_threads)
        {
            const auto stencil = stencil_at<Real>(points.position.get(i), pages.spacing, pages.stencil_shift);
            const auto seen    = see_tile(stencil, spacing, tile, Moment{});
            update_point(points, i, seen, stencil.base, pages, step, sum, peak);
        }
        block_sum<gather_threads, point_sums>(sum, shared_sums, sums + page * point_sums);
        block_largest<gather_threads, point_peaks>(peak, shared_peaks, peaks + page * point_peaks);
    }
};

} // namespace

template<class Real>
void gather(const Gpu& gpu, const PointsView<Real>& points, const PagesView& pages, const Real* motion,
            const GatherStep<Real>& step, double* sums, double* peaks)
{
    const auto launch = [&](auto moment)
    {
        for_each_block<gather_threads, blocks_an_sm<Real>>(
            gpu, "gather", pages.point_pages,
            GatherPage<Real, decltype(moment)>{points, pages, motion, step, sums, peaks});
    };
    if (points.affine.data != nullptr) { launch(WithMoment{}); }
    else { launch(WithoutMoment{}); }
}

template void gather(const Gpu&, const PointsView<float>&, const PagesView&, const float*, const GatherStep<float>&,
                     double*, double*);
template void gather(const Gpu&, const PointsView<double>&, const PagesView&, const double*, const GatherStep<double>&,
                     double*, double*);

} // namespace tread::mpm
