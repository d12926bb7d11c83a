#pragma once

#include "kernels/dem/contact/body_contact_impl.hpp"
#include "kernels/dem/contact/contact_nodes_impl.hpp"
#include "kernels/dem/contact/lane_parts.cuh"
#include "kernels/dem/motion/move_impl.hpp"
#include "kernels/dem/motion/substeps.hpp"

// Parts of a substep of bodies, for sequences in one launch (backend/repeat.cuh).
namespace tread::dem
{

inline constexpr int repeat_threads = 128, repeat_blocks_an_sm = 4;

/// Whether there are too few pairs to fill the device, so that launch latency would dominate a substep. Rolling
/// resistance and joints have separate launches; several ranks exchange wrenches between substeps.
inline bool worth_one_launch(const BodyStep<Gpu>& step)
{
    constexpr std::int64_t few = 50000;
    return step.pairs.key.size() < few && !step.pairs.resists_rolling && step.joints.row_count == 0 &&
           step.bodies.role == nullptr;
}

/// Numbers of the substeps of one launch, which ends where step.limit says so.
inline Times times_of(const BodyStep<Gpu>& step, std::int64_t count)
{
    return {count, step.limit.substep - 1, step.limit.repeated, step.limit.last};
}

template<class Meet>
auto nodes_part(const Meet& meet, const BodyStep<Gpu>& step)
{
    const std::int64_t nodes = step.pairs.nodes.node.size();
    return group_part<repeat_threads, nodes_of_word>(
        nodes > 0 ? node_words(nodes) : 0,
        contact_nodes::EvaluateNodes<Meet>{meet, step.bodies.count, step.law, step.pairs.view()});
}

template<class Meet>
auto answers_part(const Meet& meet, const BodyStep<Gpu>& step)
{
    constexpr int                        lanes = 4;
    const body_contact::AnswerPair<Meet> answer{meet, step.bodies.count, step.law, step.pairs.view(), step.motion.dt};
    return pair_part<repeat_threads, lanes>(answer.pairs, answer);
}

template<class Move>
auto move_part(const Move& move, Pairs<Gpu>& pairs)
{
    constexpr int lanes = 4;
    return body_part<repeat_threads, lanes>(move.bodies.count, pairs, move);
}

} // namespace tread::dem
