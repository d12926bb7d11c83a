#pragma once

#include <cstdint>

#include "backend/launch.cuh"
#include "backend/warp.cuh"

namespace tread::dem
{

/// Who takes part in a group's exchanges: the group alone, whatever the warp's others do.
template<int size>
struct GroupAlone
{
    __device__ static unsigned mask()
    {
        return all_lanes >> (warp_size - size) << (static_cast<int>(threadIdx.x) % warp_size / size * size);
    }
};

/// All groups of the warp together, which saves each exchange the question.
struct WholeWarp
{
    __device__ static unsigned mask() { return all_lanes; }
};

/// `size` neighbouring lanes of a warp, which share one item (see OneLane). Every sum is a butterfly: fixed order, same
/// bits in every lane.
template<int size, class Partners = GroupAlone<size>>
struct GroupLanes
{
    static_assert(warp_size % size == 0);

    __device__ std::int32_t lane() const { return static_cast<std::int32_t>(threadIdx.x) % size; }
    __device__ std::int32_t lanes() const { return size; }

    __device__ std::uint32_t vote(bool value) const
    {
        return __ballot_sync(everyone(), value) >> first() & (all_lanes >> (warp_size - size));
    }

    __device__ double from(std::int32_t lane, double value) const
    {
        return __shfl_sync(everyone(), value, first() + lane);
    }

    __device__ double sum(double value) const
    {
        for (int distance = size / 2; distance > 0; distance /= 2)
        {
            value += __shfl_xor_sync(everyone(), value, distance);
        }
        return value;
    }

    /// out[i], unless null, = the sum of all lanes' values[i], all at once: with every exchange a lane hands half of
    /// its values on, so that 24 values of 8 lanes take 21 exchanges instead of 72.
    template<int count>
    __device__ void sum_all(const double (&values)[count], double* out) const
    {
        constexpr int padded = (count + size - 1) / size * size;
        double        part[padded];
#pragma unroll
        for (int i = 0; i < padded; ++i) { part[i] = i < count ? values[i] : 0.0; }
        int first_value = 0;
#pragma unroll
        for (int across = size / 2, half = padded / 2; across > 0; across /= 2, half /= 2)
        {
            const bool upper = (lane() & across) != 0;
#pragma unroll
            for (int i = 0; i < half; ++i)
            {
                const double kept = upper ? part[i + half] : part[i], handed = upper ? part[i] : part[i + half];
                part[i] = kept + __shfl_xor_sync(everyone(), handed, across);
            }
            if (upper) { first_value += half; }
        }
#pragma unroll
        for (int i = 0; i < padded / size; ++i)
        {
            if (out != nullptr && first_value + i < count) { out[first_value + i] = part[i]; }
        }
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
    /// The group's first lane in its warp.
    __device__ static int first() { return static_cast<int>(threadIdx.x) % warp_size / size * size; }

    __device__ static unsigned everyone() { return Partners::mask(); }
};

/// Runs f(i, GroupLanes<size>) for i in [0, n), `size` lanes an item.
template<int size, class F>
void for_each_group(const Gpu& gpu, const char* name, std::int64_t n, F f)
{
    constexpr int threads = 128, groups = threads / size;
    for_each_block<threads>(gpu, name, (n + groups - 1) / groups,
                            [=] __device__(std::int64_t block)
                            {
                                const std::int64_t i = block * groups + threadIdx.x / size;
                                if (i < n) { f(i, GroupLanes<size>{}); }
                            });
}

} // namespace tread::dem
