#include "kernels/mpm/transfers/cell_divergence.hpp"

#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/mpm/transfers/cell_divergence_kern.hpp"

namespace tread::mpm
{

template<class Exec, class Real>
void average_divergence(const Exec& cpu, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
                        const Real* motion, Real dt, Real* cell_divergence)
{
    const auto average_page = [=](std::int64_t i)
    {
        const std::int64_t page = list.at(i);
        VelocityTile<Real> tile;
        for (int node = 0; node < tile_nodes; ++node) { load_velocity(motion, pages, page, node, tile); }
        for (std::int64_t cell = page * page_cells; cell < (page + 1) * page_cells; ++cell)
        {
            cell_divergence[cell] = mean_divergence(points, pages, cell, tile, dt);
        }
    };
    for_each_heavy(cpu, "cell divergence", list.count, average_page);
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void average_divergence(const Exec&, const PointsView<Real>&, const PagesView&, const PageList&,          \
                                     const Real*, Real, Real*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
