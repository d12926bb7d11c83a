#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "kernels/mpm/transfers/mean_strain_impl.hpp"

namespace tread::mpm
{

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void average_strain(const Exec&, const PointsView<Real>&, const PagesView&,                               \
                                 const MaterialParameters<Real>*, MeanStrain<Exec, Real>&)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
