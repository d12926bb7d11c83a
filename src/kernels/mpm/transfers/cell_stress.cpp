#include "kernels/mpm/transfers/cell_stress.hpp"

#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/mpm/transfers/cell_stress_kern.hpp"

namespace tread::mpm
{

template<class Exec, class Real>
void share_pressure(const Exec& cpu, const PointsView<Real>& points, const PagesView& pages,
                    const Planes<Real, 6>& shared)
{
    const auto share_page = [=](std::int64_t page)
    {
        for (std::int64_t cell = page * page_cells; cell < (page + 1) * page_cells; ++cell)
        {
            share_cell_pressure(points, pages, cell, shared);
        }
    };
    for_each_heavy(cpu, "cell pressure", pages.point_pages, share_page);
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void share_pressure(const Exec&, const PointsView<Real>&, const PagesView&, const Planes<Real, 6>&)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
