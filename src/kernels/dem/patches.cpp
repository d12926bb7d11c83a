#include "backend/launch.hpp"
#include "kernels/dem/patches_impl.hpp"

namespace tread::dem
{

void split_patches(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    const auto run = [&](const char* name, std::int64_t items, const auto& item)
    {
        constexpr std::int64_t worth_threads = 512;
        for_each_heavy(
            cpu, name, items, [=](std::int64_t p) { item(p, OneLane{}); }, worth_threads);
    };
    patches::split(cpu, pairs, bodies, law, run);
}

} // namespace tread::dem
