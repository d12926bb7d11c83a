#include "backend/launch.hpp"
#include "kernels/mpm/pages/shared_pages_impl.hpp"

namespace tread::mpm
{

template<class Real>
void sum_own_parts(const Cpu& cpu, const PagesView& pages, const Real* tiles, SharedPages<Cpu, Real>& shared)
{
    sum_all_own_parts(cpu, pages, tiles, shared);
}

template<class Real>
void add_parts(const Cpu& cpu, const Real* arrived, SharedPages<Cpu, Real>& shared)
{
    add_all_parts(cpu, arrived, shared);
}

template<class Real>
void clear_booked_elsewhere(const Cpu& cpu, const SharedPages<Cpu, Real>& shared, int width, double* tallies)
{
    clear_rows(cpu, shared, width, tallies);
}

template void sum_own_parts(const Cpu&, const PagesView&, const float*, SharedPages<Cpu, float>&);
template void sum_own_parts(const Cpu&, const PagesView&, const double*, SharedPages<Cpu, double>&);
template void add_parts(const Cpu&, const float*, SharedPages<Cpu, float>&);
template void add_parts(const Cpu&, const double*, SharedPages<Cpu, double>&);
template void clear_booked_elsewhere(const Cpu&, const SharedPages<Cpu, float>&, int, double*);
template void clear_booked_elsewhere(const Cpu&, const SharedPages<Cpu, double>&, int, double*);

} // namespace tread::mpm
