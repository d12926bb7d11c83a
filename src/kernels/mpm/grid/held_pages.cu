#include "kernels/mpm/grid/held_pages.hpp"

#include "backend/block_sum.cuh"
#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "kernels/mpm/grid/held_pages_impl.hpp"

namespace tread::mpm
{
namespace
{

/// Holds the nodes of a held page: one block per page, one thread per node.
template<class Real>
struct HoldPage
{
    PagesView             pages;
    HeldPagesView         held;
    SharedPagesView<Real> shared_pages;
    const Real*           tiles;
    GridStep<Real>        step;
    Real*                 motion;
    double*               tallies;

    __device__ void operator()(std::int64_t number) const
    {
        __shared__ double shared[page_cells / warp_size * grid_sums];
        Real              sum[grid_sums] = {};
        hold_place(pages, held, shared_pages, number, static_cast<int>(threadIdx.x), tiles, step, motion, sum);
        double* row     = tallies + std::int64_t{held.page[number]} * tally_width(grid_sums);
        double* impulse = held.impulse + 3 * number;
        block_sum<page_cells, grid_sums>(sum, shared,
                                         [=](int s, double value)
                                         {
                                             add_to_same_step(row, grid_sums, s, value);
                                             const int c = s - grid_wall_impulse;
                                             if (c >= 0) { impulse[c] += value; }
                                         });
    }
};

} // namespace

template<class Exec, class Real>
void hold_still(const Exec& gpu, const PagesView& pages, const HeldPagesView& held,
                const SharedPagesView<Real>& shared_pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                double* tallies)
{
    for_each_block<page_cells>(gpu, "hold still", held.count,
                               HoldPage<Real>{pages, held, shared_pages, tiles, step, motion, tallies});
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void hold_still(const Exec&, const PagesView&, const HeldPagesView&, const SharedPagesView<Real>&,        \
                             const Real*, const GridStep<Real>&, Real*, double*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
