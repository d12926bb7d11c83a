#include "kernels/mpm/transfers/cell_divergence.hpp"

#include "backend/launch.hpp"
#include "kernels/mpm/transfers/cell_divergence_kern.hpp"

namespace tread::mpm
{

template<class Real>
void average_divergence(const Cpu& cpu, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
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

template void average_divergence(const Cpu&, const PointsView<float>&, const PagesView&, const PageList&, const float*,
                                 float, float*);
template void average_divergence(const Cpu&, const PointsView<double>&, const PagesView&, const PageList&,
                                 const double*, double, double*);

} // namespace tread::mpm
