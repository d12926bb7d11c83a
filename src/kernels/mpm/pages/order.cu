#include "backend/launch.cuh"
#include "kernels/mpm/pages/order_impl.hpp"

namespace tread::mpm
{

template std::int64_t order_points(const Gpu&, Points<Gpu, float>&, Pages<Gpu>&, const GridGeometry&,
                                   OrderScratch<Gpu, float>&);
template std::int64_t order_points(const Gpu&, Points<Gpu, double>&, Pages<Gpu>&, const GridGeometry&,
                                   OrderScratch<Gpu, double>&);
template void         renew_order(const Gpu&, Points<Gpu, float>&, Pages<Gpu>&, OrderScratch<Gpu, float>&);
template void         renew_order(const Gpu&, Points<Gpu, double>&, Pages<Gpu>&, OrderScratch<Gpu, double>&);
template void         set_node_pages(const Gpu&, Pages<Gpu>&, const std::vector<std::uint64_t>&);

} // namespace tread::mpm
