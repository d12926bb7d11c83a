#include "backend/instantiate.hpp"
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

template<class Exec>
void split_patches(const Exec& gpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    patches::split(gpu, pairs, bodies, law, groups_of<8>(gpu));
}

template<class Exec>
bool patch_rows_suffice(const Exec& gpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return patches::rows_suffice(gpu, pairs, bodies, law, groups_of<warp_size>(gpu));
}

template<class Exec>
void regroup_patches(const Exec& gpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    patches::regroup(pairs, bodies, law, groups_of<warp_size>(gpu));
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void split_patches(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&);                         \
    template bool patch_rows_suffice(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&);                    \
    template void regroup_patches(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
