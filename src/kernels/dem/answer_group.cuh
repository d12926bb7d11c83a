#pragma once

#include "kernels/dem/body_contact_impl.hpp"
#include "kernels/dem/contact_nodes.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{

/// What a block of `threads` does with pairs: the first blocks give each pair of many nodes a warp, the others `size`
/// lanes to each of the rest.
template<class Meet, int threads, int size>
struct AnswerGroup
{
    body_contact::AnswerPair<Meet> answer;

    static constexpr int warps = threads / warp_size, groups = threads / size;

    __host__ __device__ std::int64_t blocks_of_many() const { return (answer.pairs.many_count + warps - 1) / warps; }

    std::int64_t blocks() const { return blocks_of_many() + (answer.pairs.count + groups - 1) / groups; }

    __device__ void operator()(std::int64_t block) const
    {
        const PairsView& pairs = answer.pairs;
        if (block < blocks_of_many())
        {
            const std::int64_t i = block * warps + threadIdx.x / warp_size;
            if (i < pairs.many_count) { answer(pairs.many[i], GroupLanes<warp_size>{}); }
            return;
        }
        const std::int64_t p = (block - blocks_of_many()) * groups + threadIdx.x / size;
        if (p < pairs.count && !has_many_nodes(pairs, p)) { answer(p, GroupLanes<size>{}); }
    }
};

} // namespace tread::dem
