#include "kernels/mpm/scatter.hpp"

#include "backend/launch.cuh"
#include "kernels/mpm/scatter_kern.hpp"

namespace tread::mpm
{
namespace
{

/// One block a page, one thread a cell. In one round every thread adds to the same offset of its own cell's stencil:
/// no two threads meet at a node, so plain additions in a fixed order do (design: the GPU's measured facts).
template<class Real>
struct ScatterPage
{
    PointsView<Real> points;
    PagesView        pages;
    Real*            tiles;

    __device__ void operator()(std::int64_t page) const
    {
        __shared__ Real tile[node_channels * tile_nodes];
        for (int n = threadIdx.x; n < node_channels * tile_nodes; n += page_cells) { tile[n] = 0; }

        const std::int64_t cell  = page * page_cells + threadIdx.x;
        const std::int64_t begin = pages.cell_first_point[cell], end = pages.cell_first_point[cell + 1];
        const Real         spacing = static_cast<Real>(pages.spacing);
        for (std::int64_t round = 0; __syncthreads_or(begin + round < end); ++round)
        {
            const std::int64_t i      = begin + round;
            const bool         active = i < end;
            PointLoad<Real>    load{};
            Stencil<Real>      stencil{};
            if (active)
            {
                load    = point_load(points, i);
                stencil = stencil_at<Real>(points.position.get(i), pages.spacing, pages.stencil_shift);
            }
            add_point(tile, load, stencil, spacing, active);
        }
        Real* out = tiles + page * node_channels * tile_nodes;
        for (int n = threadIdx.x; n < node_channels * tile_nodes; n += page_cells) { out[n] = tile[n]; }
    }

    __device__ static void add_point(Real* tile, const PointLoad<Real>& load, const Stencil<Real>& stencil,
                                     Real spacing, bool active)
    {
        const int base = tile_base(stencil.base);
#pragma unroll
        for (int offset = 0; offset < 27; ++offset)
        {
            const int a = offset % 3, b = offset / 3 % 3, c = offset / 9;
            if (active)
            {
                Real share[lanes];
                node_share(load, stencil, spacing, a, b, c, share);
                for (int l = 0; l < node_channels; ++l)
                {
                    tile[l * tile_nodes + base + tile_offset(a, b, c)] += share[l];
                }
            }
            __syncthreads();
        }
    }
};

} // namespace

template<class Real>
void scatter(const Gpu& gpu, const PointsView<Real>& points, const PagesView& pages, Real* tiles)
{
    for_each_block<page_cells>(gpu, "scatter", pages.point_pages, ScatterPage<Real>{points, pages, tiles});
}

template void scatter(const Gpu&, const PointsView<float>&, const PagesView&, float*);
template void scatter(const Gpu&, const PointsView<double>&, const PagesView&, double*);

} // namespace tread::mpm
