#include "kernels/mpm/transfers/cell_stress.hpp"

#include "backend/launch.cuh"
#include "kernels/mpm/transfers/cell_stress_kern.hpp"

namespace tread::mpm
{

template<class Real>
void share_pressure(const Gpu& gpu, const PointsView<Real>& points, const PagesView& pages,
                    const Planes<Real, 6>& shared)
{
    for_each(gpu, "cell pressure", page_cells * pages.point_pages,
             [=] __device__(std::int64_t cell) { share_cell_pressure(points, pages, cell, shared); });
}

template void share_pressure(const Gpu&, const PointsView<float>&, const PagesView&, const Planes<float, 6>&);
template void share_pressure(const Gpu&, const PointsView<double>&, const PagesView&, const Planes<double, 6>&);

} // namespace tread::mpm
