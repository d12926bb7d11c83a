#include "backend/launch.hpp"
#include "kernels/dem/body_contact_impl.hpp"

namespace tread::dem
{

void evaluate_contacts(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    by_narrow_phase(law,
                    [&](const auto& meet)
                    {
                        const body_contact::EvaluatePair evaluate{meet, bodies, law, pairs.view(), dt};
                        constexpr std::int64_t           worth_threads = 128;
                        for_each_heavy(
                            cpu, "body contacts", pairs.key.size(), [=](std::int64_t p) { evaluate(p, OneLane{}); },
                            worth_threads);
                    });
}

} // namespace tread::dem
