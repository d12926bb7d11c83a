#pragma once

#include <cstdint>

#include "backend/launch.cuh"
#include "backend/warp.cuh"

namespace tread::dem
{

/// Group of `size` neighbouring lanes of a warp, which share one item (see OneLane). Every sum is a butterfly: fixed
/// order, same bits in every lane.
template<int size>
struct GroupLanes
{
    static_assert(warp_size % size == 0);

    __device__ std::int32_t lane() const { return static_cast<std::int32_t>(threadIdx.x) % size; }
    __device__ std::int32_t lanes() const { return size; }

    __device__ std::uint32_t vote(bool value) const
    {
        return __ballot_sync(everyone(), value) >> first() & (all_lanes >> (warp_size - size));
    }

    __device__ std::uint32_t share(std::uint32_t bits) const
    {
        return bits & all_lanes / (all_lanes >> (warp_size - size)) << lane();
    }

    __device__ double from(std::int32_t lane, double value) const
    {
        return __shfl_sync(everyone(), value, first() + lane);
    }

    /// Waits for the other lanes, and sees what they have written.
    __device__ void sync() const { __syncwarp(everyone()); }

    __device__ double sum(double value) const
    {
        for (int distance = size / 2; distance > 0; distance /= 2)
        {
            value += __shfl_xor_sync(everyone(), value, distance);
        }
        return value;
    }

    __device__ double largest(double value) const
    {
        for (int distance = size / 2; distance > 0; distance /= 2)
        {
            value = fmax(value, __shfl_xor_sync(everyone(), value, distance));
        }
        return value;
    }

private:
    /// Returns the group's first lane in its warp.
    __device__ static int first() { return static_cast<int>(threadIdx.x) % warp_size / size * size; }

    /// Returns the mask of the group's lanes, whatever the other lanes of the warp do.
    __device__ static unsigned everyone() { return all_lanes >> (warp_size - size) << first(); }
};

/// Calls f(i, GroupLanes<size>) for i in [0, n) with `size` lanes per item, for blocks of `threads` threads.
template<int threads, int size, class F>
struct GroupsOfBlock
{
    F            f;
    std::int64_t n;

    static constexpr int groups = threads / size;

    std::int64_t blocks() const { return (n + groups - 1) / groups; }

    __device__ void operator()(std::int64_t block) const
    {
        const std::int64_t i = block * groups + threadIdx.x / size;
        if (i < n) { f(i, GroupLanes<size>{}); }
    }
};

/// Runs f(i, GroupLanes<size>) for i in [0, n); `blocks_an_sm` as in for_each_block.
template<int size, int blocks_an_sm = 1, class F>
void for_each_group(const Gpu& gpu, const char* name, std::int64_t n, F f)
{
    constexpr int                         threads = 128;
    const GroupsOfBlock<threads, size, F> block{f, n};
    for_each_block<threads, blocks_an_sm>(gpu, name, block.blocks(), block);
}

} // namespace tread::dem
