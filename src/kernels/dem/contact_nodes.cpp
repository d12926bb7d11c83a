#include "backend/launch.hpp"
#include "kernels/dem/contact_nodes_impl.hpp"

namespace tread::dem
{

void list_contact_nodes(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    const auto run = [&](const char* name, std::int64_t items, const auto& item)
    {
        constexpr std::int64_t worth_threads = 64;
        for_each_heavy(
            cpu, name, items, [=](std::int64_t p) { item(p, OneLane{}); }, worth_threads);
    };
    contact_nodes::list_nodes(cpu, pairs, bodies, law, dt, run);
}

} // namespace tread::dem
