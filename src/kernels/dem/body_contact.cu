#include "kernels/dem/pair_block.cuh"

namespace tread::dem
{
namespace
{

using namespace pair_block;
using body_contact::EvaluatePair;

/// Pairs without nodes, all exact spheres: a thread each.
template<class Meet>
struct EvaluateSpheres
{
    EvaluatePair<Meet> evaluate;

    __device__ void operator()(std::int64_t block) const
    {
        __shared__ Raw<PairResponse[threads]> shared;
        const PairsView&                      pairs = evaluate.pairs;
        const PairRun<threads>                run(block, pairs.count);
        const int                             mine    = static_cast<int>(threadIdx.x);
        auto*                                 patches = reinterpret_cast<Patch*>(&shared);
        copy_words(patches, pairs.patch + run.begin, run.count);
        __syncthreads();
        PairResponse response = no_response();
        if (mine < run.count)
        {
            body_contact::PairSetting setting;
            evaluate.set_pair(run.begin + mine, setting);
            response                     = evaluate.answer(run.begin + mine, setting, no_nodes(), patches[mine]);
            pairs.peak[run.begin + mine] = fmax(pairs.peak[run.begin + mine], response.overlap);
        }
        __syncthreads();
        copy_words(pairs.patch + run.begin, patches, run.count);
        __syncthreads();
        if (mine < run.count) { shared.value[mine] = response; }
        __syncthreads();
        copy_words(pairs.response + run.begin, shared.value, run.count);
    }
};

/// Any pairs: a thread works out the answer of a pair when its nodes are added up.
template<class Meet, int size>
struct EvaluateBlock
{
    EvaluatePair<Meet> evaluate;

    struct Shared
    {
        PairsOfBlock<size> pairs;
        Patch              patch[size];
        union
        {
            NodeSums     sums[size];
            PairResponse response[size];
        };
    };

    __device__ void operator()(std::int64_t block) const
    {
        __shared__ Raw<Shared> raw;
        Shared&                shared = raw.value;
        const PairsView&       pairs  = evaluate.pairs;
        const PairRun<size>    run(block, pairs.count);
        copy_words(shared.patch, pairs.patch + run.begin, run.count);
        set_up(evaluate, run, shared.pairs);
        __syncthreads();
        sum_nodes(run, shared);
        __syncthreads();
        const int    mine     = static_cast<int>(threadIdx.x);
        PairResponse response = no_response();
        if (mine < run.count)
        {
            const std::int64_t p = run.begin + mine;
            response      = evaluate.answer(p, shared.pairs.setting[mine], shared.sums[mine], shared.patch[mine]);
            pairs.peak[p] = fmax(pairs.peak[p], response.overlap);
        }
        __syncthreads();
        if (mine < run.count) { shared.response[mine] = response; }
        copy_words(pairs.patch + run.begin, shared.patch, run.count);
        __syncthreads();
        copy_words(pairs.response + run.begin, shared.response, run.count);
    }

    /// Two walks over the nodes: the second needs what the first has added up.
    __device__ void sum_nodes(const PairRun<size>& run, Shared& shared) const
    {
        constexpr int                    room = PairsOfBlock<size>::room;
        const OwnPair<size>              own(run, shared.pairs);
        const body_contact::PairSetting& setting = shared.pairs.setting[own.pair];
        const std::int32_t               begin = shared.pairs.first[0], end = shared.pairs.first[run.count];
        NodeSums                         sums       = no_nodes();
        double                           relaxation = 0;
        for (int walk = 0; walk < 2; ++walk)
        {
            for (std::int32_t base = begin; base < end; base += room)
            {
                if (walk == 0 || end - begin > room) { look_up(evaluate, run, base, shared.pairs); }
                own(base, shared.pairs,
                    [&](const NodeInField& node)
                    {
                        if (!(node.overlap > 0)) { return; }
                        if (walk == 1) { add_node(setting.law, node, setting.motion, relaxation, sums.patch); }
                        else { add_stiffness(setting.law, node, evaluate.stiffening(setting, node), sums.stiffness); }
                    });
            }
            if (walk == 1) { break; }
            sums.stiffness = {own.lanes.sum(sums.stiffness.sum), own.lanes.largest(sums.stiffness.overlap)};
            relaxation     = relaxation_time(setting.law, sums.stiffness.sum);
        }
        double values[sizeof(PatchSums) / sizeof(double)];
        sums.patch.write_to(values);
        auto* found = reinterpret_cast<double*>(&shared.sums[own.pair].patch);
        own.lanes.sum_all(values, own.exists ? found : nullptr);
        if (own.exists && own.lanes.lane() == 0) { shared.sums[own.pair].stiffness = sums.stiffness; }
    }
};

template<class Meet>
void evaluate_pairs(const Gpu& gpu, const EvaluatePair<Meet>& evaluate, std::int64_t nodes)
{
    const std::int64_t count = evaluate.pairs.count;
    if (nodes == 0)
    {
        for_each_block<threads, blocks_an_sm>(gpu, "body contacts", (count + threads - 1) / threads,
                                              EvaluateSpheres<Meet>{evaluate});
        return;
    }
    by_count(count,
             [&](auto size)
             {
                 for_each_block<threads, blocks_an_sm>(gpu, "body contacts", (count + size - 1) / size,
                                                       EvaluateBlock<Meet, size>{evaluate});
             });
}

} // namespace

void evaluate_contacts(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    by_narrow_phase(law,
                    [&](const auto& meet) {
                        evaluate_pairs(gpu, EvaluatePair{meet, bodies, law, pairs.view(), dt}, pairs.node.size());
                    });
    if (!pairs.resists_rolling) { return; }
    for_each(gpu, "resistance to rolling", pairs.key.size(),
             body_contact::ResistRolling{bodies, law, pairs.view(), dt});
}

} // namespace tread::dem
