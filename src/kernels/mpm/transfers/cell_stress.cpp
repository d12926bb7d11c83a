#include "kernels/mpm/transfers/cell_stress.hpp"

#include "backend/launch.hpp"
#include "kernels/mpm/transfers/cell_stress_kern.hpp"

namespace tread::mpm
{

template<class Real>
void share_pressure(const Cpu& cpu, const PointsView<Real>& points, const PagesView& pages,
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

template void share_pressure(const Cpu&, const PointsView<float>&, const PagesView&, const Planes<float, 6>&);
template void share_pressure(const Cpu&, const PointsView<double>&, const PagesView&, const Planes<double, 6>&);

} // namespace tread::mpm
