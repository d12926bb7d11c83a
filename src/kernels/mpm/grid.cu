#include "kernels/mpm/grid.hpp"

#include "backend/block_sum.cuh"
#include "backend/launch.cuh"
#include "kernels/mpm/wall_step_kern.hpp"

namespace tread::mpm
{
namespace
{

/// One block a node page, one thread a node.
template<class Real>
struct UpdatePage
{
    PagesView      pages;
    const Real*    tiles;
    GridStep<Real> step;
    Real*          motion;
    double*        tallies;

    __device__ void operator()(std::int64_t page) const
    {
        __shared__ double shared[page_cells / 32 * grid_sums];
        __shared__ std::int32_t tile_pages[octants];
        const int               place = static_cast<int>(threadIdx.x);
        if (place < octants) { tile_pages[place] = tile_page(pages, page, place); }
        __syncthreads();
        Real   channels[node_channels];
        double sum[grid_sums] = {};
        sum_tiles(tile_pages, tiles, place, channels);
        update_node(step, node_at(page_coordinates(pages.node_page_key[page]), place), channels,
                    motion + page * motion_channels * page_cells + place, sum);
        double* row = tallies + page * tally_width(grid_sums);
        block_sum<page_cells, grid_sums>(sum, shared, [=](int s, double value) { book(row, grid_sums, s, value); });
    }
};

/// One block a node page, one thread a node; pages without walls end at once.
template<class Real>
struct UpdateWallPage
{
    PagesView      pages;
    const Real*    tiles;
    GridStep<Real> step;
    Real*          motion;
    double*        tallies;

    __device__ void operator()(std::int64_t page) const
    {
        __shared__ double shared[page_cells / 32 * grid_sums];
        const Index3      at = page_coordinates(pages.node_page_key[page]);
        if (!touches_wall(step.walls, at)) { return; }
        const Index3 node           = node_at(at, static_cast<int>(threadIdx.x));
        double       sum[grid_sums] = {};
        if (owns_pairs(step.walls, node)) { update_owned(pages, {at, page}, tiles, step, node, motion, sum); }
        double* row = tallies + page * tally_width(grid_sums);
        block_sum<page_cells, grid_sums>(sum, shared,
                                         [=](int s, double value) { book_more(row, grid_sums, s, value); });
    }
};

} // namespace

template<class Real>
void update_grid(const Gpu& gpu, const PagesView& pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                 double* tallies)
{
    for_each_block<page_cells>(gpu, "update grid", pages.node_pages,
                               UpdatePage<Real>{pages, tiles, step, motion, tallies});
}

template<class Real>
void update_walls(const Gpu& gpu, const PagesView& pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                  double* tallies)
{
    for_each_block<page_cells>(gpu, "update walls", pages.node_pages,
                               UpdateWallPage<Real>{pages, tiles, step, motion, tallies});
}

template void update_grid(const Gpu&, const PagesView&, const float*, const GridStep<float>&, float*, double*);
template void update_grid(const Gpu&, const PagesView&, const double*, const GridStep<double>&, double*, double*);
template void update_walls(const Gpu&, const PagesView&, const float*, const GridStep<float>&, float*, double*);
template void update_walls(const Gpu&, const PagesView&, const double*, const GridStep<double>&, double*, double*);

} // namespace tread::mpm
