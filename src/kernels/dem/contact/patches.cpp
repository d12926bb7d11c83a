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

void split_patches(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    patches::split(cpu, pairs, bodies, law, lanes_of(cpu));
}

bool patch_rows_suffice(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return patches::rows_suffice(cpu, pairs, bodies, law, lanes_of(cpu));
}

void regroup_patches(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    patches::regroup(pairs, bodies, law, lanes_of(cpu));
}

} // namespace tread::dem
