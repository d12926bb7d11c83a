#include "backend/launch.cuh"
#include "kernels/dem/contact/patches_impl.hpp"
#include "kernels/dem/contact/warp_lanes.cuh"

namespace tread::dem
{

namespace
{

template<int lanes>
auto groups_of(const Gpu& gpu)
{
    return [&gpu](const char* name, std::int64_t items, const auto& item)
    { for_each_group<lanes>(gpu, name, items, item); };
}

} // namespace

void split_patches(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    patches::split(gpu, pairs, bodies, law, groups_of<8>(gpu));
}

bool patch_rows_suffice(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return patches::rows_suffice(gpu, pairs, bodies, law, groups_of<warp_size>(gpu));
}

void regroup_patches(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    patches::regroup(pairs, bodies, law, groups_of<warp_size>(gpu));
}

} // namespace tread::dem
