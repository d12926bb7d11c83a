#include "backend/launch.cuh"
#include "kernels/dem/body_contact_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
namespace
{

using body_contact::EvaluatePair;
using body_contact::PairSetting;

constexpr int threads = 128, blocks_an_sm = 4;

/// Copies between records and shared memory by all threads of a block, so that neighbours touch neighbouring words: a
/// record is many words long, and a thread that reads one alone touches a line for each.
template<class T>
__device__ void copy_words(T* to, const T* from, int records)
{
    constexpr int words = sizeof(T) / sizeof(double);
    static_assert(sizeof(T) == words * sizeof(double));
    auto*       target = reinterpret_cast<double*>(to);
    const auto* source = reinterpret_cast<const double*>(from);
    for (int i = static_cast<int>(threadIdx.x); i < records * words; i += threads) { target[i] = source[i]; }
}

/// Memory of a block whose values have no constructor.
template<class T>
union Raw
{
    __device__ Raw() {}

    T value;
};

/// A run of `size` neighbouring pairs, and how many there are.
template<int size>
struct PairRun
{
    std::int64_t begin;
    int          count;

    __device__ PairRun(std::int64_t block, std::int64_t pairs)
        : begin(block * size)
        , count(static_cast<int>(pairs - begin < size ? pairs - begin : size))
    {
    }
};

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
            PairSetting setting;
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

/// Any pairs. A block sets up `size` of them; all its threads look up their nodes, wherever one pair's end and the
/// next one's begin; groups of lanes add up the nodes of a pair each; a thread works out the answer of a pair each.
template<class Meet, int size>
struct EvaluateBlock
{
    EvaluatePair<Meet> evaluate;

    static constexpr int room = 384; ///< nodes at a time

    struct Shared
    {
        PairSetting  setting[size];
        Patch        patch[size];
        NodeSums     sums[size];
        std::int32_t first[size + 1]; ///< nodes of the pairs
        union
        {
            NodeInField  node[room];
            PairResponse response[size];
        };
    };

    using Lanes = GroupLanes<threads / size, WholeWarp>;

    __device__ void operator()(std::int64_t block) const
    {
        __shared__ Raw<Shared> raw;
        Shared&                shared = raw.value;
        const PairsView&       pairs  = evaluate.pairs;
        const PairRun<size>    run(block, pairs.count);
        const int              mine = static_cast<int>(threadIdx.x);
        set_up(run, shared);
        __syncthreads();
        sum_nodes(run, shared);
        __syncthreads();
        PairResponse response = no_response();
        if (mine < run.count)
        {
            const std::int64_t p  = run.begin + mine;
            response              = evaluate.answer(p, shared.setting[mine], shared.sums[mine], shared.patch[mine]);
            pairs.peak[p]         = fmax(pairs.peak[p], response.overlap);
            shared.response[mine] = response;
        }
        __syncthreads();
        copy_words(pairs.patch + run.begin, shared.patch, run.count);
        copy_words(pairs.response + run.begin, shared.response, run.count);
    }

    __device__ void set_up(const PairRun<size>& run, Shared& shared) const
    {
        copy_words(shared.patch, evaluate.pairs.patch + run.begin, run.count);
        for (int i = static_cast<int>(threadIdx.x); i < 4 * size; i += threads)
        {
            const int pair = i % size, part = i / size;
            if (pair >= run.count) { continue; }
            const std::int64_t p = run.begin + pair;
            if (part == 0) { evaluate.set_pair(p, shared.setting[pair]); }
            else if (part == 1) { shared.first[pair] = evaluate.pairs.first_node[p]; }
            else if (part == 2 || second_of(evaluate.pairs.key[p]) < evaluate.bodies.count)
            {
                evaluate.set_body(p, part - 2, shared.setting[pair]);
            }
        }
        if (threadIdx.x == 0) { shared.first[run.count] = evaluate.pairs.first_node[run.begin + run.count]; }
    }

    /// Two walks over the nodes: the second needs what the first has added up. Lanes without a pair walk along.
    __device__ void sum_nodes(const PairRun<size>& run, Shared& shared) const
    {
        const Lanes        lanes;
        const int          group   = static_cast<int>(threadIdx.x) / (threads / size);
        const bool         mine    = group < run.count;
        const int          pair    = mine ? group : 0;
        const PairSetting& setting = shared.setting[pair];
        const std::int32_t begin = shared.first[0], end = shared.first[run.count];
        const std::int32_t own_first = mine ? shared.first[pair] : end, own_last = mine ? shared.first[pair + 1] : end;
        NodeSums           sums       = no_nodes();
        double             relaxation = 0;
        for (int walk = 0; walk < 2; ++walk)
        {
            for (std::int32_t base = begin; base < end; base += room)
            {
                if (walk == 0 || end - begin > room)
                {
                    __syncthreads();
                    look_up(run, base, min(base + room, end), shared);
                    __syncthreads();
                }
                const std::int32_t last = min(own_last, base + room);
                for (std::int32_t i = max(own_first, base) + lanes.lane(); i < last; i += lanes.lanes())
                {
                    const NodeInField& node = shared.node[i - base];
                    if (!(node.overlap > 0)) { continue; }
                    if (walk == 0)
                    {
                        add_stiffness(setting.law, node, evaluate.stiffening(setting, node), sums.stiffness);
                    }
                    else { add_node(setting.law, node, setting.motion, relaxation, sums.patch); }
                }
            }
            if (walk == 1) { break; }
            sums.stiffness = {lanes.sum(sums.stiffness.sum), lanes.largest(sums.stiffness.overlap)};
            relaxation     = relaxation_time(setting.law, sums.stiffness.sum);
        }
        double values[sizeof(PatchSums) / sizeof(double)];
        sums.patch.write_to(values);
        double* own = reinterpret_cast<double*>(&shared.sums[pair].patch);
        lanes.sum_all(values, mine ? own : nullptr);
        if (mine && lanes.lane() == 0) { shared.sums[pair].stiffness = sums.stiffness; }
    }

    __device__ void look_up(const PairRun<size>& run, std::int32_t begin, std::int32_t end, Shared& shared) const
    {
        for (std::int32_t i = begin + static_cast<int>(threadIdx.x); i < end; i += threads)
        {
            const auto pair =
                static_cast<int>(lower_bound(shared.first, static_cast<std::int64_t>(run.count), i + 1)) - 1;
            shared.node[i - begin] = evaluate.look_up(run.begin + pair, shared.setting[pair], evaluate.pairs.node[i]);
        }
    }
};

template<int size, class Meet>
void evaluate_any(const Gpu& gpu, const EvaluatePair<Meet>& evaluate)
{
    for_each_block<threads, blocks_an_sm>(gpu, "body contacts", (evaluate.pairs.count + size - 1) / size,
                                          EvaluateBlock<Meet, size>{evaluate});
}

/// Few pairs take more lanes each.
template<class Meet>
void evaluate_pairs(const Gpu& gpu, const EvaluatePair<Meet>& evaluate, std::int64_t nodes)
{
    constexpr std::int64_t many  = 50000;
    const std::int64_t     count = evaluate.pairs.count;
    if (nodes == 0)
    {
        for_each_block<threads, blocks_an_sm>(gpu, "body contacts", (count + threads - 1) / threads,
                                              EvaluateSpheres<Meet>{evaluate});
    }
    else if (count < many) { evaluate_any<16>(gpu, evaluate); }
    else { evaluate_any<32>(gpu, evaluate); }
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
