#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "kernels/mpm/pages/shared_pages_impl.hpp"

namespace tread::mpm
{

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void sum_own_parts(const Exec&, const PagesView&, const Real*, SharedPages<Exec, Real>&);                 \
    template void add_parts(const Exec&, const Real*, SharedPages<Exec, Real>&);                                       \
    template void clear_tallied_elsewhere(const Exec&, const SharedPages<Exec, Real>&, int, double*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
