#pragma once

#include "backend/repeat.cuh"
#include "kernels/dem/answer_group.cuh"
#include "kernels/dem/contact_nodes_impl.hpp"
#include "kernels/dem/move_impl.hpp"
#include "kernels/dem/substeps.hpp"
#include "kernels/dem/warp_lanes.cuh"

// The parts of a substep of bodies, for sequences that run on the device alone (backend/repeat.cuh).
namespace tread::dem
{

inline constexpr int repeat_threads = 128, repeat_blocks_an_sm = 4;

/// f(i, lanes).
template<int lanes, class F>
auto groups(std::int64_t items, const F& f)
{
    const GroupsOfBlock<repeat_threads, lanes, F> block{f, items};
    return Part{block.blocks(), block};
}

/// Fewer pairs than fill the device: waiting between launches would be most of a substep. Resistance to rolling has a
/// launch of its own.
inline bool worth_one_launch(Pairs<Gpu>& pairs)
{
    constexpr std::int64_t few = 50000;
    return pairs.key.size() < few && !pairs.resists_rolling;
}

template<class Meet>
auto nodes_part(const Meet& meet, const BodyStep<Gpu>& step)
{
    const std::int64_t nodes = step.pairs.node.size();
    return groups<nodes_of_word>(nodes > 0 ? node_words(nodes) : 0,
                                 contact_nodes::LookUp<Meet>{meet, step.bodies.count, step.law, step.pairs.view()});
}

template<class Meet>
auto answers_part(const Meet& meet, const BodyStep<Gpu>& step)
{
    constexpr int                                  lanes = 4;
    const AnswerGroup<Meet, repeat_threads, lanes> group{
        {meet, step.bodies.count, step.law, step.pairs.view(), step.motion.dt}};
    return Part{group.blocks(), group};
}

template<class Move>
auto move_part(const Move& move, Pairs<Gpu>& pairs)
{
    constexpr int lanes = 4;
    return beside(groups<warp_size>(pairs.large.size(), moving::MoveLarge<Move>{move, pairs.large.data()}),
                  groups<lanes>(move.bodies.count, moving::MoveSmall<Move>{move, pairs.is_large.data()}));
}

} // namespace tread::dem
