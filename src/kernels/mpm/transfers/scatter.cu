#include "kernels/mpm/transfers/scatter.hpp"

#include "backend/instantiate.hpp"
#include "kernels/mpm/transfers/scatter_full_page.cuh"
#include "kernels/mpm/transfers/scatter_sparse_page.cuh"

namespace tread::mpm
{
namespace
{

/// Mean number of points per page below which pages count as sparse.
constexpr std::int64_t full_page = 128;

} // namespace

template<class Exec, class Real>
void scatter(const Exec& gpu, const PointsView<Real>& points, const PagesView& pages, const PageList& list, Real* tiles)
{
    const auto launch = [&](auto load)
    {
        using Brings = decltype(load);
        if (points.count < full_page * pages.point_pages)
        {
            for_each_block<warp_size>(gpu, "scatter", list.count,
                                      ScatterSparsePage<Real, Brings>{points, pages, list, tiles});
        }
        else
        {
            using FullPage = ScatterPage<Real, Brings>;
            for_each_block<scatter_threads, FullPage::blocks>(gpu, "scatter", list.count,
                                                              FullPage{points, pages, list, tiles});
        }
    };
    const auto with_force = [&](auto force)
    {
        if (points.affine.data != nullptr) { launch(Load<force, true>{}); }
        else { launch(Load<force, false>{}); }
    };
    if (points.contact_force.data != nullptr) { with_force(std::true_type{}); }
    else { with_force(std::false_type{}); }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void scatter(const Exec&, const PointsView<Real>&, const PagesView&, const PageList&, Real*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
