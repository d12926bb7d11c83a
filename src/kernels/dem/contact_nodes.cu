#include "kernels/dem/contact_nodes_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{

void list_contact_nodes(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    const auto run = [&](const char* name, std::int64_t items, const auto& item)
    { for_each_group<warp_size>(gpu, name, items, item); };
    contact_nodes::list_nodes(gpu, pairs, bodies, law, dt, run);
}

} // namespace tread::dem
