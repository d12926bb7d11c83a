#pragma once

#include "kernels/dem/contact/warp_lanes.cuh"

namespace tread::dem
{

/// All lanes of a block of `threads` threads, which share one item (see OneLane). Every lane must call every sum; sums
/// have a fixed order and the same bits in all lanes.
template<int threads>
struct BlockLanes
{
    __device__ std::int32_t lane() const { return static_cast<std::int32_t>(threadIdx.x); }
    __device__ std::int32_t lanes() const { return threads; }

    __device__ double sum(double value) const
    {
        constexpr int               warps = threads / warp_size;
        __shared__ double           of_warp[warps];
        const GroupLanes<warp_size> warp;
        const double                own = warp.sum(value);
        __syncthreads(); // lanes may still be reading of_warp for the previous sum
        if (warp.lane() == 0) { of_warp[threadIdx.x / warp_size] = own; }
        __syncthreads();
        double sum = 0;
        for (const double part : of_warp) { sum += part; }
        return sum;
    }
};

/// Calls f(i, BlockLanes<threads>), one item per block.
template<int threads, class F>
struct ItemOfBlock
{
    F f;

    __device__ void operator()(std::int64_t block) const { f(block, BlockLanes<threads>{}); }
};

} // namespace tread::dem
