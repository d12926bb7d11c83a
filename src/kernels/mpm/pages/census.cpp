#include "kernels/mpm/pages/census.hpp"

#include "backend/launch.hpp"
#include "kernels/mpm/pages/census_kern.hpp"

namespace tread::mpm
{

template<class Real>
void take_census(const Cpu& cpu, const PointsView<Real>& points, const PagesView& pages,
                 const MaterialParameters<Real>* materials, double* rows)
{
    const auto count_page = [=](std::int64_t page)
    {
        double* row = rows + page * census_count;
        for (int c = 0; c < census_count; ++c) { row[c] = 0; }
        for (std::int64_t at = pages.first_point[page]; at < pages.first_point[page + 1]; ++at)
        {
            count_point(points, pages.point_at[at], materials, row);
        }
    };
    for_each_heavy(cpu, "census", pages.point_pages, count_page);
}

template void take_census(const Cpu&, const PointsView<float>&, const PagesView&, const MaterialParameters<float>*,
                          double*);
template void take_census(const Cpu&, const PointsView<double>&, const PagesView&, const MaterialParameters<double>*,
                          double*);

} // namespace tread::mpm
