#include "backend/launch.hpp"
#include "kernels/mpm/pages/leaving_impl.hpp"

namespace tread::mpm
{

template void find_leaving(const Cpu&, Points<Cpu, float>&, const GridGeometry&, const PageOwnersView&, std::int32_t,
                           Leaving<Cpu>&, OrderScratch<Cpu, float>&);
template void remove_leaving(const Cpu&, Points<Cpu, float>&, const Leaving<Cpu>&, OrderScratch<Cpu, float>&);
template void find_leaving(const Cpu&, Points<Cpu, double>&, const GridGeometry&, const PageOwnersView&, std::int32_t,
                           Leaving<Cpu>&, OrderScratch<Cpu, double>&);
template void remove_leaving(const Cpu&, Points<Cpu, double>&, const Leaving<Cpu>&, OrderScratch<Cpu, double>&);

} // namespace tread::mpm
