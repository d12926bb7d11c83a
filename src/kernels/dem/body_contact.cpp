#include "backend/launch.hpp"
#include "kernels/dem/body_contact_impl.hpp"

namespace tread::dem
{

void add_body_contacts(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law,
                       BodyTotal* totals, double dt)
{
    const body_contact::EvaluatePair evaluate{bodies, law, pairs.view(), dt};
    constexpr std::int64_t           worth_threads = 512; // most listed pairs are apart and cost little
    for_each_heavy(
        cpu, "body contacts", pairs.key.size(), [=](std::int64_t p) { evaluate(p, OneLane{}); }, worth_threads);
    const body_contact::GatherBody gather{bodies, pairs.view(), totals, dt};
    for_each(cpu, "gather body contacts", bodies.count, [=](std::int64_t b) { gather(b, OneLane{}); });
}

} // namespace tread::dem
