#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/dem/contact/body_contact_impl.hpp"

namespace tread::dem
{

template<class Exec>
void answer_contacts(const Exec& cpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    by_narrow_phase(law,
                    [&]<class Meet>(const Meet& meet)
                    {
                        const body_contact::AnswerPair<Meet> answer{meet, bodies.count, law, pairs.view(), dt};
                        constexpr std::int64_t               worth_threads = 2048; // about a millisecond
                        for_each_heavy(
                            cpu, "body contacts", pairs.key.size(), [=](std::int64_t p) { answer(p, OneLane{}); },
                            worth_threads);
                    });
    if (!pairs.resists_rolling) { return; }
    for_each(cpu, "resistance to rolling", pairs.key.size(),
             body_contact::ResistRolling{bodies.count, law, pairs.view(), dt});
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void answer_contacts(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&, double)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
