#include "backend/launch.cuh"
#include "kernels/dem/patches_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{

void split_patches(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    constexpr int pair_lanes = 8;
    const auto    run        = [&](const char* name, std::int64_t items, const auto& item)
    { for_each_group<pair_lanes>(gpu, name, items, item); };
    patches::split(gpu, pairs, bodies, law, run);
}

} // namespace tread::dem
