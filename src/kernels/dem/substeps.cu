#include "kernels/dem/substeps.hpp"

#include "backend/repeat.cuh"
#include "kernels/dem/answer_group.cuh"
#include "kernels/dem/body_contact.hpp"
#include "kernels/dem/contact_nodes_impl.hpp"
#include "kernels/dem/move_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
namespace
{

constexpr int threads = 128, blocks_an_sm = 4;

/// f(i, lane) as the parts of a sequence want it.
template<int lanes, class F>
auto part(std::int64_t items, const F& f)
{
    const GroupsOfBlock<threads, lanes, F> block{f, items};
    return Part{block.blocks(), block};
}

template<class Meet>
auto answers(const body_contact::AnswerPair<Meet>& answer)
{
    constexpr int                           lanes = 4;
    const AnswerGroup<Meet, threads, lanes> group{answer};
    return Part{group.blocks(), group};
}

/// Few enough that the waiting between launches would be most of a substep.
bool worth_one_launch(Pairs<Gpu>& pairs)
{
    constexpr std::int64_t few = 50000;
    return pairs.node.size() > 0 && pairs.key.size() < few && !pairs.resists_rolling;
}

} // namespace

void run_substeps(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, BodyTotal* totals,
                  const NamedImpulses& named, const Motion& motion, std::int64_t count)
{
    if (!worth_one_launch(pairs))
    {
        for (std::int64_t substep = 0; substep < count; ++substep)
        {
            evaluate_contacts(gpu, pairs, bodies, law, motion.dt);
            move_bodies(gpu, pairs, bodies, totals, named, motion);
        }
        return;
    }
    const PairsView          view = pairs.view();
    const moving::GatherBody gather{bodies, view, totals, motion.dt};
    const auto large = part<warp_size>(pairs.large.size(), moving::GatherLarge{gather, pairs.large.data()});
    by_narrow_phase(
        law,
        [&]<class Meet>(const Meet& meet)
        {
            const auto nodes        = part<nodes_of_word>(node_words(pairs.node.size()),
                                                   contact_nodes::LookUp<Meet>{meet, bodies.count, law, view});
            const auto pair_answers = answers(body_contact::AnswerPair<Meet>{meet, bodies.count, law, view, motion.dt});
            moving::with_move(gather, pairs.is_large.data(), named, motion,
                              [&](const auto& move)
                              {
                                  repeat<threads, blocks_an_sm>(
                                      gpu, "substeps of bodies", count,
                                      sequence(nodes, pair_answers, large, part<4>(bodies.count, move)));
                              });
        });
}

} // namespace tread::dem
