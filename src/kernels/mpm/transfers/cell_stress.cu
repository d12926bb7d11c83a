#include "kernels/mpm/transfers/cell_stress.hpp"

#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "kernels/mpm/transfers/cell_stress_kern.hpp"

namespace tread::mpm
{

template<class Exec, class Real>
void share_pressure(const Exec& gpu, const PointsView<Real>& points, const PagesView& pages,
                    const Planes<Real, 6>& shared)
{
    for_each(gpu, "cell pressure", page_cells * pages.point_pages,
             [=] __device__(std::int64_t cell) { share_cell_pressure(points, pages, cell, shared); });
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void share_pressure(const Exec&, const PointsView<Real>&, const PagesView&, const Planes<Real, 6>&)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
