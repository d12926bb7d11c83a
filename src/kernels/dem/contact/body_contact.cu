#include "backend/instantiate.hpp"
#include "kernels/dem/contact/body_contact_impl.hpp"
#include "kernels/dem/contact/lane_parts.cuh"

namespace tread::dem
{
namespace
{

template<int lanes, class Meet>
void answer_pairs(const Gpu& gpu, const body_contact::AnswerPair<Meet>& answer)
{
    constexpr int threads = 64, blocks_an_sm = 8;
    const auto    part = pair_part<threads, lanes>(answer.pairs, answer);
    for_each_block<threads, blocks_an_sm>(gpu, "body contacts", part.blocks, part.f);
}

} // namespace

template<class Exec>
void answer_contacts(const Exec& gpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    constexpr std::int64_t few = 50000; // too few to fill the device
    by_narrow_phase(law,
                    [&]<class Meet>(const Meet& meet)
                    {
                        const body_contact::AnswerPair<Meet> answer{meet, bodies.count, law, pairs.view(), dt};
                        if (pairs.key.size() < few) { answer_pairs<4>(gpu, answer); }
                        else { answer_pairs<1>(gpu, answer); }
                    });
    if (!pairs.resists_rolling) { return; }
    for_each(gpu, "resistance to rolling", pairs.key.size(),
             body_contact::ResistRolling{bodies.count, law, pairs.view(), dt});
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void answer_contacts(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&, double)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
