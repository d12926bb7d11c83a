#include "kernels/mpm/pages/census.hpp"

#include "backend/block_sum.cuh"
#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "kernels/mpm/pages/census_kern.hpp"

namespace tread::mpm
{
namespace
{

constexpr int census_threads = 128;

/// Sums one page per block; its points are assigned to the threads in order.
template<class Real>
struct CountPage
{
    PointsView<Real>                points;
    PagesView                       pages;
    const MaterialParameters<Real>* materials;
    double*                         rows;

    __device__ void operator()(std::int64_t page) const
    {
        __shared__ double shared[census_threads / 32 * census_count];
        double            row[census_count] = {};
        for (std::int64_t at = pages.first_point[page] + threadIdx.x; at < pages.first_point[page + 1];
             at += census_threads)
        {
            count_point(points, pages.point_at[at], materials, row);
        }
        double* out = rows + page * census_count;
        block_sum<census_threads, census_count>(row, shared, [=](int which, double value) { out[which] = value; });
    }
};

} // namespace

template<class Exec, class Real>
void take_census(const Exec& gpu, const PointsView<Real>& points, const PagesView& pages,
                 const MaterialParameters<Real>* materials, double* rows)
{
    for_each_block<census_threads>(gpu, "census", pages.point_pages, CountPage<Real>{points, pages, materials, rows});
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void take_census(const Exec&, const PointsView<Real>&, const PagesView&, const MaterialParameters<Real>*, \
                              double*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
