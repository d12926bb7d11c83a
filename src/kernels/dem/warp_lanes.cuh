#pragma once

#include <cstdint>

#include "backend/launch.cuh"
#include "backend/warp.cuh"

namespace tread::dem
{

/// The 32 lanes of a warp, which share one item (see OneLane). Every sum is a butterfly: fixed order, same bits in
/// every lane.
struct WarpLanes
{
    static constexpr unsigned     everyone = all_lanes;
    static constexpr std::int32_t size     = warp_size;

    __device__ std::int32_t lane() const { return static_cast<std::int32_t>(threadIdx.x) % size; }
    __device__ std::int32_t lanes() const { return size; }
    __device__ std::uint32_t vote(bool value) const { return __ballot_sync(everyone, value); }

    __device__ double sum(double value) const
    {
        for (int distance = size / 2; distance > 0; distance /= 2)
        {
            value += __shfl_xor_sync(everyone, value, distance);
        }
        return value;
    }

    __device__ double largest(double value) const
    {
        for (int distance = size / 2; distance > 0; distance /= 2)
        {
            value = fmax(value, __shfl_xor_sync(everyone, value, distance));
        }
        return value;
    }
};

/// Runs f(i, WarpLanes) for i in [0, n), one warp an item.
template<class F>
void for_each_warp(const Gpu& gpu, const char* name, std::int64_t n, F f)
{
    constexpr int threads = 128, warps = threads / WarpLanes::size;
    for_each_block<threads>(gpu, name, (n + warps - 1) / warps,
                            [=] __device__(std::int64_t block)
                            {
                                const std::int64_t i = block * warps + threadIdx.x / WarpLanes::size;
                                if (i < n) { f(i, WarpLanes{}); }
                            });
}

} // namespace tread::dem
