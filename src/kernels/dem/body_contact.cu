#include <type_traits>

#include "kernels/dem/body_contact_impl.hpp"
#include "kernels/dem/contact_nodes.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
namespace
{

using body_contact::AnswerPair;
using body_contact::PairSetting;

constexpr int threads = 128, blocks_an_sm = 4, warps = threads / warp_size;

/// Copies between records and shared memory by all lanes of a warp, so that neighbours touch neighbouring words: a
/// record is many words long, and a lane that touches one alone touches a line for each.
template<class T>
__device__ void copy_words(T* to, const T* from, int records)
{
    constexpr int words = sizeof(T) / sizeof(double);
    static_assert(sizeof(T) == words * sizeof(double));
    auto*       target = reinterpret_cast<double*>(to);
    const auto* source = reinterpret_cast<const double*>(from);
    for (int i = static_cast<int>(threadIdx.x) % warp_size; i < records * words; i += warp_size)
    {
        target[i] = source[i];
    }
}

/// Memory of a block whose values have no constructor.
template<class T>
union Raw
{
    __device__ Raw() {}

    T value;
};

/// A warp takes `size` neighbouring pairs. `lanes` lanes add up the nodes of a pair, as many pairs at a time as there
/// are lanes for; then every pair's answer is worked out by one lane.
template<class Meet, int lanes, int size>
struct AnswerWarp
{
    AnswerPair<Meet> answer;

    struct Shared
    {
        union
        {
            PairSetting setting[size];
            Patch       patch[size];
        };
        union
        {
            NodeSums     sums[size];
            PairResponse response[size];
        };
    };

    __device__ void operator()(std::int64_t block) const
    {
        __shared__ Raw<Shared> raw[warps];
        Shared&                shared = raw[threadIdx.x / warp_size].value;
        const PairsView&       pairs  = answer.pairs;
        const std::int64_t     begin  = (block * warps + threadIdx.x / warp_size) * size;
        const auto             count  = static_cast<int>(pairs.count - begin < size ? pairs.count - begin : size);
        if (count <= 0) { return; }
        const int  mine   = static_cast<int>(threadIdx.x) % warp_size;
        const bool exists = mine < count;
        if (exists)
        {
            shared.setting[mine] = body_contact::setting_of(answer.bodies, answer.law, pairs.key[begin + mine]);
        }
        __syncwarp();
        add_up(begin, count, shared);
        __syncwarp();
        PairResponse response = no_response();
        Patch        patch    = no_patch();
        if (exists)
        {
            const std::int64_t p = begin + mine;
            patch                = pairs.patch[p];
            answer.touch_spheres(p, shared.setting[mine], shared.sums[mine]);
            response      = answer.answer(p, shared.setting[mine], shared.sums[mine], patch);
            pairs.peak[p] = fmax(pairs.peak[p], response.overlap);
        }
        __syncwarp();
        if (exists)
        {
            shared.patch[mine]    = patch;
            shared.response[mine] = response;
        }
        __syncwarp();
        copy_words(pairs.patch + begin, shared.patch, count);
        copy_words(pairs.response + begin, shared.response, count);
    }

    __device__ void add_up(std::int64_t begin, int count, Shared& shared) const
    {
        constexpr int                      at_a_time = warp_size / lanes;
        const GroupLanes<lanes, WholeWarp> group;
        for (int first = 0; first < count; first += at_a_time)
        {
            const int own  = first + static_cast<int>(threadIdx.x) % warp_size / lanes;
            const int pair = own < count ? own : first; // of no pair: goes along for the exchanges
            NodeSums  sums = answer.sum_nodes(begin + pair, shared.setting[pair], group);
            double    values[sizeof(PatchSums) / sizeof(double)];
            sums.patch.write_to(values);
            group.sum_all(values, own < count ? reinterpret_cast<double*>(&shared.sums[pair].patch) : nullptr);
            if (own < count && group.lane() == 0) { shared.sums[pair].stiffness = sums.stiffness; }
        }
    }
};

/// Pairs without nodes, all exact spheres: a lane each.
template<class Meet>
struct AnswerSpheres
{
    AnswerPair<Meet> answer;

    __device__ void operator()(std::int64_t block) const
    {
        __shared__ Raw<PairResponse[warp_size]> raw[warps];
        PairResponse*                           responses = raw[threadIdx.x / warp_size].value;
        auto*                                   patches   = reinterpret_cast<Patch*>(responses);
        const PairsView&                        pairs     = answer.pairs;
        const std::int64_t                      begin     = (block * warps + threadIdx.x / warp_size) * warp_size;
        const auto count = static_cast<int>(pairs.count - begin < warp_size ? pairs.count - begin : warp_size);
        if (count <= 0) { return; }
        const int mine = static_cast<int>(threadIdx.x) % warp_size;
        copy_words(patches, pairs.patch + begin, count);
        __syncwarp();
        PairResponse response = no_response();
        if (mine < count)
        {
            const std::int64_t p       = begin + mine;
            const PairSetting  setting = body_contact::setting_of(answer.bodies, answer.law, pairs.key[p]);
            NodeSums           sums    = no_nodes();
            answer.touch_spheres(p, setting, sums);
            response      = answer.answer(p, setting, sums, patches[mine]);
            pairs.peak[p] = fmax(pairs.peak[p], response.overlap);
        }
        __syncwarp();
        copy_words(pairs.patch + begin, patches, count);
        __syncwarp();
        if (mine < count) { responses[mine] = response; }
        __syncwarp();
        copy_words(pairs.response + begin, responses, count);
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
    constexpr int          lanes = 4;
    const std::int64_t     count = answer.pairs.count;
    if (nodes == 0) { for_each_warp<warp_size>(gpu, count, AnswerSpheres<Meet>{answer}); }
    else if (count < many)
    {
        constexpr int few = warp_size / lanes; // all at a time
        for_each_warp<few>(gpu, count, AnswerWarp<Meet, lanes, few>{answer});
    }
    else { for_each_warp<warp_size>(gpu, count, AnswerWarp<Meet, lanes, warp_size>{answer}); }
}

} // namespace

void evaluate_contacts(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    look_up_nodes(gpu, pairs, bodies, law);
    by_narrow_phase(law,
                    [&](const auto& meet) {
                        answer_pairs(gpu, AnswerPair{meet, bodies, law, pairs.view(), dt}, pairs.node.size());
                    });
    if (!pairs.resists_rolling) { return; }
    for_each(gpu, "resistance to rolling", pairs.key.size(),
             body_contact::ResistRolling{bodies, law, pairs.view(), dt});
}

} // namespace tread::dem
