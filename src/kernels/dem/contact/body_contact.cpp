#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/dem/contact/body_contact_impl.hpp"
#include "kernels/dem/contact/contact_nodes_impl.hpp"

namespace tread::dem
{

template<class Exec>
void evaluate_contacts(const Exec& cpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt,
                       const Subcycle& cycle)
{
    constexpr std::int64_t worth_threads = 2048; // about a millisecond
    evaluate_nodes(cpu, pairs, bodies, law, cycle);
    contact_nodes::by_meeting(
        law, cycle,
        [&](const auto& meet, const auto& part)
        {
            const auto answer = body_contact::AnswerPair{meet, bodies.count, law, pairs.view(), dt, part};
            for_each_heavy(
                cpu, "body contacts", pairs.key.size(), [=](std::int64_t p) { answer(p, OneLane{}); }, worth_threads);
        });
    if (!pairs.resists_rolling) { return; }
    by_cycle(cycle,
             [&](const auto& part)
             {
                 for_each(cpu, "resistance to rolling", pairs.key.size(),
                          body_contact::ResistRolling{bodies.count, law, pairs.view(), dt, part});
             });
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void evaluate_contacts(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&, double,              \
                                    const Subcycle&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
