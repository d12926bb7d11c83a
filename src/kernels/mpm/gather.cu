#include "kernels/mpm/gather.hpp"

#include "backend/block_sum.cuh"
#include "backend/launch.cuh"
#include "kernels/mpm/gather_kern.hpp"

namespace tread::mpm
{
namespace
{

constexpr int gather_threads = 128;

/// Lanes of one tile node, planar in shared memory.
template<class Real>
struct SharedNode
{
    const Real* at;

    __device__ Real operator[](int lane) const { return lane < motion_channels ? at[lane * tile_nodes] : Real(0); }
};

/// One block a page: its tile in shared memory, its points dealt to the threads in order.
template<class Real>
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
        __shared__ Real   tile[motion_channels * tile_nodes];
        __shared__ double shared[gather_threads * point_sums];
        for (int node = threadIdx.x; node < tile_nodes; node += gather_threads)
        {
            const Real* source = tile_source(motion, pages.node_page_of + 8 * page, node);
            for (int c = 0; c < motion_channels; ++c) { tile[c * tile_nodes + node] = source[c * page_cells]; }
        }
        __syncthreads();
        double     sum[point_sums] = {}, peak[point_peaks] = {};
        const Real spacing = static_cast<Real>(pages.spacing);
        for (std::int64_t i = pages.first_point[page] + threadIdx.x; i < pages.first_point[page + 1];
             i += gather_threads)
        {
            const auto stencil = stencil_at<Real>(points.position.get(i), pages.spacing, pages.stencil_shift);
            const auto seen    = see(stencil, spacing, [&](int node) { return SharedNode<Real>{tile + node}; });
            update_point(points, i, seen, stencil.base, pages, step, sum, peak);
        }
        block_sum<gather_threads, point_sums>(sum, shared, sums + page * point_sums);
        __syncthreads();
        largest(peak, shared, peaks + page * point_peaks);
    }

    __device__ static void largest(const double* values, double* shared, double* out)
    {
        for (int p = 0; p < point_peaks; ++p) { shared[p * gather_threads + threadIdx.x] = values[p]; }
        __syncthreads();
        if (threadIdx.x < point_peaks)
        {
            double value = 0;
            for (int t = 0; t < gather_threads; ++t) { value = fmax(value, shared[threadIdx.x * gather_threads + t]); }
            out[threadIdx.x] = value;
        }
    }
};

} // namespace

template<class Real>
void gather(const Gpu& gpu, const PointsView<Real>& points, const PagesView& pages, const Real* motion,
            const GatherStep<Real>& step, double* sums, double* peaks)
{
    static_assert(int{point_peaks} <= int{point_sums});
    for_each_block<gather_threads>(gpu, "gather", pages.point_pages,
                                   GatherPage<Real>{points, pages, motion, step, sums, peaks});
}

template void gather(const Gpu&, const PointsView<float>&, const PagesView&, const float*, const GatherStep<float>&,
                     double*, double*);
template void gather(const Gpu&, const PointsView<double>&, const PagesView&, const double*, const GatherStep<double>&,
                     double*, double*);

} // namespace tread::mpm
