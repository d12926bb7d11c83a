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
        const Index3 at   = page_coordinates(pages.node_page_key[page]);
        Real*        here = motion + page * motion_channels * page_cells + place;
        if (has_held_nodes(step.walls, at)) { update_node(step, node_at(at, place), channels, here, sum); }
        else { update_free_node(step, node_at(at, place), channels, here, sum); }
        double* row = tallies + page * tally_width(grid_sums);
        block_sum<page_cells, grid_sums>(sum, shared, [=](int s, double value) { book(row, grid_sums, s, value); });
    }
};

/// One block a wall page, one thread a node. An axis: what is across it is held; none: the nodes are finished.
template<class Real>
struct WallPage
{
    PagesView      pages;
    PageList       wall_pages;
    const Real*    tiles;
    GridStep<Real> step;
    Real*          motion;
    double*        tallies;

    __device__ HomePage home(std::int64_t i) const
    {
        const std::int64_t page = wall_pages.page[i];
        return {page_coordinates(pages.node_page_key[page]), page};
    }

    __device__ void book_page(std::int64_t page, const double* sum) const
    {
        __shared__ double shared[page_cells / 32 * grid_sums];
        double*           row = tallies + page * tally_width(grid_sums);
        block_sum<page_cells, grid_sums>(sum, shared,
                                         [=](int s, double value) { book_more(row, grid_sums, s, value); });
    }
};

template<class Real>
struct HoldPage : WallPage<Real>
{
    int axis;

    __device__ void operator()(std::int64_t i) const
    {
        const HomePage at             = this->home(i);
        double         sum[grid_sums] = {};
        hold_group(this->pages, at, this->step.walls, node_at(at.at, static_cast<int>(threadIdx.x)), axis, this->motion,
                   sum);
        this->book_page(at.number, sum);
    }
};

template<class Real>
struct FinishPage : WallPage<Real>
{
    __device__ void operator()(std::int64_t i) const
    {
        __shared__ std::int32_t tile_pages[octants];
        const HomePage          at             = this->home(i);
        double                  sum[grid_sums] = {};
        const int               place          = static_cast<int>(threadIdx.x);
        if (place < octants) { tile_pages[place] = tile_page(this->pages, at.number, place); }
        __syncthreads();
        const Index3 node = node_at(at.at, place);
        finish_held(tile_pages, this->tiles, this->step, node, motion_of(this->motion, at.number, node), sum);
        this->book_page(at.number, sum);
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
void update_walls(const Gpu& gpu, const PagesView& pages, const PageList& wall_pages, const Real* tiles,
                  const GridStep<Real>& step, Real* motion, double* tallies)
{
    const WallPage<Real> page{pages, wall_pages, tiles, step, motion, tallies};
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!has_walls(step.walls, axis)) { continue; }
        for_each_block<page_cells>(gpu, "hold walls", wall_pages.count, HoldPage<Real>{page, axis});
    }
    for_each_block<page_cells>(gpu, "finish walls", wall_pages.count, FinishPage<Real>{page});
}

template void update_grid(const Gpu&, const PagesView&, const float*, const GridStep<float>&, float*, double*);
template void update_grid(const Gpu&, const PagesView&, const double*, const GridStep<double>&, double*, double*);
template void update_walls(const Gpu&, const PagesView&, const PageList&, const float*, const GridStep<float>&, float*,
                           double*);
template void update_walls(const Gpu&, const PagesView&, const PageList&, const double*, const GridStep<double>&,
                           double*, double*);

} // namespace tread::mpm
