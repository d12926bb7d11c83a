#include "kernels/mpm/transfers/cell_divergence.hpp"

#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "kernels/mpm/transfers/cell_divergence_kern.hpp"

namespace tread::mpm
{
namespace
{

/// Averages one page per block, one cell per thread.
template<class Real>
struct AveragePage
{
    PointsView<Real> points;
    PagesView        pages;
    PageList         list;
    const Real*      motion;
    Real             dt;
    Real*            cell_divergence;

    __device__ void operator()(std::int64_t block) const
    {
        const std::int64_t page = list.at(block);
        __shared__ VelocityTile<Real> tile;
        for (int node = threadIdx.x; node < tile_nodes; node += page_cells)
        {
            load_velocity(motion, pages, page, node, tile);
        }
        __syncthreads();
        const std::int64_t cell = page * page_cells + threadIdx.x;
        cell_divergence[cell]   = mean_divergence(points, pages, cell, tile, dt);
    }
};

} // namespace

template<class Exec, class Real>
void average_divergence(const Exec& gpu, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
                        const Real* motion, Real dt, Real* cell_divergence)
{
    for_each_block<page_cells>(gpu, "cell divergence", list.count,
                               AveragePage<Real>{points, pages, list, motion, dt, cell_divergence});
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void average_divergence(const Exec&, const PointsView<Real>&, const PagesView&, const PageList&,          \
                                     const Real*, Real, Real*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
