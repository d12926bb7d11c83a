#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/mpm/transfers/mean_strain_impl.hpp"

namespace tread::mpm
{

Smoothing make_smoothing(double length)
{
    constexpr double of_transfers = 0.25, largest_share = 0.125;
    const double     variance = length * length - of_transfers;
    const int        passes   = static_cast<int>(std::ceil(variance / (2 * largest_share)));
    return {passes, variance / (2 * passes), std::max<std::int64_t>(static_cast<std::int64_t>(length), 1)};
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void average_strain(const Exec&, const PointsView<Real>&, const PagesView&,                               \
                                 const MaterialParameters<Real>*, MeanStrain<Exec, Real>&)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
