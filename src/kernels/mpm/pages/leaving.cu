#include "backend/launch.cuh"
#include "kernels/mpm/pages/leaving_impl.hpp"

namespace tread::mpm
{

template void find_leaving(const Gpu&, Points<Gpu, float>&, const GridGeometry&, const PageOwnersView&, std::int32_t,
                           Leaving<Gpu>&, OrderScratch<Gpu, float>&);
template void remove_leaving(const Gpu&, Points<Gpu, float>&, const Leaving<Gpu>&, OrderScratch<Gpu, float>&);
template void find_leaving(const Gpu&, Points<Gpu, double>&, const GridGeometry&, const PageOwnersView&, std::int32_t,
                           Leaving<Gpu>&, OrderScratch<Gpu, double>&);
template void remove_leaving(const Gpu&, Points<Gpu, double>&, const Leaving<Gpu>&, OrderScratch<Gpu, double>&);

} // namespace tread::mpm
