#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/dem/contact/patches_impl.hpp"

namespace tread::dem
{

namespace
{

auto lanes_of(const Cpu& cpu)
{
    return [&cpu](const char* name, std::int64_t items, const auto& item)
    {
        constexpr std::int64_t worth_threads = 512;
        for_each_heavy(
            cpu, name, items, [=](std::int64_t p) { item(p, OneLane{}); }, worth_threads);
    };
}

} // namespace

template<class Exec>
void split_patches(const Exec& cpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    patches::split(cpu, pairs, bodies, law, lanes_of(cpu));
}

template<class Exec>
bool patch_rows_suffice(const Exec& cpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return patches::rows_suffice(cpu, pairs, bodies, law, lanes_of(cpu));
}

template<class Exec>
void regroup_patches(const Exec& cpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    patches::regroup(pairs, bodies, law, lanes_of(cpu));
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void split_patches(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&);                         \
    template bool patch_rows_suffice(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&);                    \
    template void regroup_patches(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
