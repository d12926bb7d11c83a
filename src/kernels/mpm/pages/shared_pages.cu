#include "backend/launch.cuh"
#include "kernels/mpm/pages/shared_pages_impl.hpp"

namespace tread::mpm
{

template<class Real>
void sum_own_parts(const Gpu& gpu, const PagesView& pages, const Real* tiles, SharedPages<Gpu, Real>& shared)
{
    sum_all_own_parts(gpu, pages, tiles, shared);
}

template<class Real>
void add_parts(const Gpu& gpu, const Real* arrived, SharedPages<Gpu, Real>& shared)
{
    add_all_parts(gpu, arrived, shared);
}

template<class Real>
void clear_booked_elsewhere(const Gpu& gpu, const SharedPages<Gpu, Real>& shared, int width, double* tallies)
{
    clear_rows(gpu, shared, width, tallies);
}

template void sum_own_parts(const Gpu&, const PagesView&, const float*, SharedPages<Gpu, float>&);
template void sum_own_parts(const Gpu&, const PagesView&, const double*, SharedPages<Gpu, double>&);
template void add_parts(const Gpu&, const float*, SharedPages<Gpu, float>&);
template void add_parts(const Gpu&, const double*, SharedPages<Gpu, double>&);
template void clear_booked_elsewhere(const Gpu&, const SharedPages<Gpu, float>&, int, double*);
template void clear_booked_elsewhere(const Gpu&, const SharedPages<Gpu, double>&, int, double*);

} // namespace tread::mpm
