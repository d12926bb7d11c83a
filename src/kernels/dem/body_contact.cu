#include "kernels/dem/answer_warp.cuh"
#include "kernels/dem/contact_nodes.hpp"

namespace tread::dem
{
namespace
{

using body_contact::AnswerPair;
using body_contact::PairSetting;

constexpr int threads = 64, blocks_an_sm = 7, warps = threads / warp_size;

/// Pairs without nodes, all exact spheres: a lane each.
template<class Meet>
struct AnswerSpheres
{
    AnswerPair<Meet> answer;

    __device__ void operator()(std::int64_t block) const
    {
        __shared__ Raw<Patch[warp_size]> raw[warps];
        Patch*                           patches = raw[threadIdx.x / warp_size].value;
        const PairsView&                 pairs   = answer.pairs;
        const std::int64_t               begin   = (block * warps + threadIdx.x / warp_size) * warp_size;
        const auto count = static_cast<int>(pairs.count - begin < warp_size ? pairs.count - begin : warp_size);
        if (count <= 0) { return; }
        const int mine = static_cast<int>(threadIdx.x) % warp_size;
        copy_words(patches, pairs.patch + begin, count);
        __syncwarp();
        if (mine < count)
        {
            const std::int64_t p       = begin + mine;
            const PairSetting  setting = body_contact::setting_of(pairs, answer.law, answer.bodies, pairs.key[p]);
            NodeSums           sums    = no_nodes();
            answer.touch_spheres(p, setting, sums);
            answer.write(p, answer.answer(p, setting, sums, patches[mine]));
        }
        __syncwarp();
        copy_words(pairs.patch + begin, patches, count);
    }
};

template<int size, class Block>
void for_each_warp(const Gpu& gpu, std::int64_t pairs, const Block& block)
{
    constexpr int in_block = warps * size;
    for_each_block<threads, blocks_an_sm>(gpu, "body contacts", (pairs + in_block - 1) / in_block, block);
}

template<class Meet>
void answer_pairs(const Gpu& gpu, const AnswerPair<Meet>& answer, std::int64_t nodes)
{
    constexpr std::int64_t many  = 50000;
    constexpr int          few   = 8; // of a warp: all its nodes at a time, as a rule
    const std::int64_t     count = answer.pairs.count;
    if (nodes == 0) { for_each_warp<warp_size>(gpu, count, AnswerSpheres<Meet>{answer}); }
    else if (count < many) { for_each_warp<few>(gpu, count, AnswerWarp<Meet, few, warps>{answer}); }
    else { for_each_warp<warp_size>(gpu, count, AnswerWarp<Meet, warp_size, warps>{answer}); }
}

} // namespace

void evaluate_contacts(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    look_up_nodes(gpu, pairs, bodies, law);
    by_narrow_phase(law,
                    [&](const auto& meet) {
                        answer_pairs(gpu, AnswerPair{meet, bodies.count, law, pairs.view(), dt}, pairs.node.size());
                    });
    if (!pairs.resists_rolling) { return; }
    for_each(gpu, "resistance to rolling", pairs.key.size(),
             body_contact::ResistRolling{bodies.count, law, pairs.view(), dt});
}

} // namespace tread::dem
