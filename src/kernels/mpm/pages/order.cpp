#include "backend/launch.hpp"
#include "kernels/mpm/pages/order_impl.hpp"

namespace tread::mpm
{

template std::int64_t order_points(const Cpu&, Points<Cpu, float>&, Pages<Cpu>&, const GridGeometry&,
                                   OrderScratch<Cpu, float>&);
template std::int64_t order_points(const Cpu&, Points<Cpu, double>&, Pages<Cpu>&, const GridGeometry&,
                                   OrderScratch<Cpu, double>&);
template void         renew_order(const Cpu&, Points<Cpu, float>&, Pages<Cpu>&, OrderScratch<Cpu, float>&);
template void         renew_order(const Cpu&, Points<Cpu, double>&, Pages<Cpu>&, OrderScratch<Cpu, double>&);
template void         set_node_pages(const Cpu&, Pages<Cpu>&, const std::vector<std::uint64_t>&);

} // namespace tread::mpm
