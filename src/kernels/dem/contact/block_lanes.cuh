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
        return of_warps(GroupLanes<warp_size>{}.sum(value), [](double a, double b) { return a + b; });
    }

    __device__ double largest(double value) const
    {
        return of_warps(GroupLanes<warp_size>{}.largest(value), [](double a, double b) { return fmax(a, b); });
    }

private:
    template<class Combine>
    __device__ static double of_warps(double value, Combine combine)
    {
        constexpr int     warps = threads / warp_size;
        __shared__ double of_warp[warps];
        __syncthreads(); // lanes may still be reading of_warp for the previous value
        if (GroupLanes<warp_size>{}.lane() == 0) { of_warp[threadIdx.x / warp_size] = value; }
        __syncthreads();
        double all = of_warp[0];
        for (int warp = 1; warp < warps; ++warp) { all = combine(all, of_warp[warp]); }
        return all;
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
