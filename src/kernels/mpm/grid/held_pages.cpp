#include "kernels/mpm/grid/held_pages.hpp"

#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/mpm/grid/held_pages_impl.hpp"

namespace tread::mpm
{

template<class Exec, class Real>
void hold_still(const Exec& cpu, const PagesView& pages, const HeldPagesView& held,
                const SharedPagesView<Real>& shared_pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                double* tallies)
{
    const auto hold_page = [=](std::int64_t number)
    {
        double sum[grid_sums] = {};
        for (int place = 0; place < page_cells; ++place)
        {
            hold_place(pages, held, shared_pages, number, place, tiles, step, motion, sum);
        }
        double* row = tallies + std::int64_t{held.page[number]} * tally_width(grid_sums);
        for (int s = 0; s < grid_sums; ++s) { add_to_same_step(row, grid_sums, s, sum[s]); }
        for (int c = 0; c < 3; ++c) { held.impulse[3 * number + c] += sum[grid_wall_impulse + c]; }
    };
    for_each_heavy(cpu, "hold still", held.count, hold_page);
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void hold_still(const Exec&, const PagesView&, const HeldPagesView&, const SharedPagesView<Real>&,        \
                             const Real*, const GridStep<Real>&, Real*, double*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
