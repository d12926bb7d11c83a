#include "kernels/mpm/pages/census.hpp"

#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/mpm/pages/census_kern.hpp"

namespace tread::mpm
{

template<class Exec, class Real>
void take_census(const Exec& cpu, const PointsView<Real>& points, const PagesView& pages,
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

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void take_census(const Exec&, const PointsView<Real>&, const PagesView&, const MaterialParameters<Real>*, \
                              double*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
