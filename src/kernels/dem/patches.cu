#include "backend/launch.cuh"
#include "kernels/dem/patches_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{

namespace
{

auto lanes_of(const Gpu& gpu)
{
    constexpr int pair_lanes = 8;
    return [&gpu](const char* name, std::int64_t items, const auto& item)
    { for_each_group<pair_lanes>(gpu, name, items, item); };
}

} // namespace

void split_patches(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    patches::split(gpu, pairs, bodies, law, lanes_of(gpu));
}

bool regroup_patches(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return patches::regroup(gpu, pairs, bodies, law, lanes_of(gpu));
}

} // namespace tread::dem
