#include "backend/launch.cuh"
#include "kernels/dem/body_contact_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
namespace
{

constexpr int threads = 128, blocks_an_sm = 4;

/// Lanes that share a pair's nodes: most pairs list about as many.
constexpr int node_lanes = 8;

/// Copies between records and shared memory by all threads of a block, so that neighbours touch neighbouring words: a
/// record is many words long, and a thread that reads one alone touches a line for each.
template<class T>
__device__ void copy_words(T* to, const T* from, std::int64_t records)
{
    constexpr int words = sizeof(T) / sizeof(double);
    static_assert(sizeof(T) == words * sizeof(double));
    auto*       target = reinterpret_cast<double*>(to);
    const auto* source = reinterpret_cast<const double*>(from);
    for (std::int64_t i = threadIdx.x; i < records * words; i += threads) { target[i] = source[i]; }
}

/// A block takes `size` neighbouring pairs: first groups of lanes add up the nodes of one pair after the other, then
/// each pair's answer is worked out by one thread.
template<class Meet, int size>
struct EvaluateBlock
{
    body_contact::EvaluatePair<Meet> evaluate;

    __device__ void operator()(std::int64_t block) const
    {
        union Shared
        {
            __device__ Shared() {}

            struct
            {
                NodeSums nodes[size];
                Patch    patch[size];
                Couple   couple[threads / node_lanes];
            } in;
            PairResponse out[size];
        };
        __shared__ Shared shared;

        const PairsView&   pairs = evaluate.pairs;
        const std::int64_t begin = block * size;
        const auto         count = static_cast<int>(pairs.count - begin < size ? pairs.count - begin : size);
        copy_words(shared.in.patch, pairs.patch + begin, count);
        if (pairs.first_node[begin] < pairs.first_node[begin + count])
        {
            sum_nodes(begin, count, shared.in.nodes, shared.in.couple);
        }
        __syncthreads();

        const int    mine     = static_cast<int>(threadIdx.x);
        PairResponse response = no_response();
        if (mine < count)
        {
            const std::int64_t p     = begin + mine;
            const bool         empty = pairs.first_node[p] == pairs.first_node[p + 1];
            response      = evaluate.answer(p, empty ? no_nodes() : shared.in.nodes[mine], shared.in.patch[mine]);
            pairs.peak[p] = fmax(pairs.peak[p], response.overlap);
        }
        __syncthreads();
        copy_words(pairs.patch + begin, shared.in.patch, count);
        __syncthreads();
        if (mine < count) { shared.out[mine] = response; }
        __syncthreads();
        copy_words(pairs.response + begin, shared.out, count);
    }

    __device__ void sum_nodes(std::int64_t begin, int count, NodeSums* shared, Couple* couples) const
    {
        const GroupLanes<node_lanes> lanes;
        const int                    group = static_cast<int>(threadIdx.x) / node_lanes;
        for (int pair = group; pair < count; pair += threads / node_lanes)
        {
            lanes.meet();
            const NodeSums own = evaluate.sum_nodes(begin + pair, lanes, couples[group]);
            if (lanes.lane() == 0) { shared[pair].stiffness = own.stiffness; }
            if (!(own.stiffness.overlap > 0)) { continue; }
            constexpr int words = sizeof(PatchSums) / sizeof(double);
            double        values[words];
            own.patch.write_to(values);
            lanes.sum_all(values, reinterpret_cast<double*>(&shared[pair].patch));
        }
    }
};

template<int size, class Meet>
void evaluate_blocks(const Gpu& gpu, const body_contact::EvaluatePair<Meet>& evaluate)
{
    for_each_block<threads, blocks_an_sm>(gpu, "body contacts", (evaluate.pairs.count + size - 1) / size,
                                          EvaluateBlock<Meet, size>{evaluate});
}

} // namespace

void evaluate_contacts(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    constexpr std::int64_t many = 100000; // enough for blocks whose every thread answers for a pair
    by_narrow_phase(law,
                    [&](const auto& meet)
                    {
                        const body_contact::EvaluatePair evaluate{meet, bodies, law, pairs.view(), dt};
                        if (pairs.key.size() < many) { evaluate_blocks<threads / node_lanes>(gpu, evaluate); }
                        else { evaluate_blocks<threads>(gpu, evaluate); }
                    });
    if (!pairs.resists_rolling) { return; }
    for_each(gpu, "resistance to rolling", pairs.key.size(),
             body_contact::ResistRolling{bodies, law, pairs.view(), dt});
}

} // namespace tread::dem
