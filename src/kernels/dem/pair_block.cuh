#pragma once

#include "backend/launch.cuh"
#include "kernels/dem/body_contact_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

// Blocks of threads that take neighbouring pairs together. All of a block's threads look up the nodes of its pairs,
// wherever one pair's end and the next one's begin; groups of lanes then go over the nodes of a pair each.
namespace tread::dem::pair_block
{

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

/// What a block of `size` pairs shares.
template<int size>
struct PairsOfBlock
{
    static constexpr int room = 384; ///< nodes at a time

    body_contact::PairSetting setting[size];
    std::int32_t              first[size + 1]; ///< nodes of the pairs
    NodeInField               node[room];
};

/// Sets up the pairs of a run; then the block must meet.
template<class Meet, int size>
__device__ void set_up(const body_contact::EvaluatePair<Meet>& evaluate, const PairRun<size>& run,
                       PairsOfBlock<size>& shared)
{
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

/// Looks up as many nodes from `base` on as there is room for; begins and ends with the block's meeting.
template<class Meet, int size>
__device__ void look_up(const body_contact::EvaluatePair<Meet>& evaluate, const PairRun<size>& run, std::int32_t base,
                        PairsOfBlock<size>& shared)
{
    __syncthreads();
    const std::int32_t end = min(base + PairsOfBlock<size>::room, shared.first[run.count]);
    for (std::int32_t i = base + static_cast<int>(threadIdx.x); i < end; i += threads)
    {
        const auto pair = static_cast<int>(lower_bound(shared.first, static_cast<std::int64_t>(run.count), i + 1)) - 1;
        shared.node[i - base] = evaluate.look_up(run.begin + pair, shared.setting[pair], evaluate.pairs.node[i]);
    }
    __syncthreads();
}

/// The lanes of a pair, and its nodes; lanes without a pair have no nodes, and go along for the exchanges.
template<int size>
struct OwnPair
{
    GroupLanes<threads / size, WholeWarp> lanes;
    bool                                  exists;
    int                                   pair; ///< of the run
    std::int32_t                          first, last;

    __device__ OwnPair(const PairRun<size>& run, const PairsOfBlock<size>& shared)
        : exists(static_cast<int>(threadIdx.x) / (threads / size) < run.count)
        , pair(exists ? static_cast<int>(threadIdx.x) / (threads / size) : 0)
        , first(exists ? shared.first[pair] : shared.first[run.count])
        , last(exists ? shared.first[pair + 1] : shared.first[run.count])
    {
    }

    /// Shows this lane's nodes of those that were looked up from `base` on.
    template<class Visit>
    __device__ void operator()(std::int32_t base, const PairsOfBlock<size>& shared, Visit visit) const
    {
        const std::int32_t end = min(last, base + PairsOfBlock<size>::room);
        for (std::int32_t i = max(first, base) + lanes.lane(); i < end; i += lanes.lanes())
        {
            visit(shared.node[i - base]);
        }
    }
};

/// run(size) with the pairs that a block is to take: few pairs have more lanes each.
template<class Run>
void by_count(std::int64_t pairs, Run run)
{
    constexpr std::int64_t many = 50000;
    if (pairs < many) { run(std::integral_constant<int, 16>{}); }
    else { run(std::integral_constant<int, 32>{}); }
}

} // namespace tread::dem::pair_block
