#pragma once

#include <bit>

#include "backend/warp.cuh"

namespace tread
{

struct AddValues
{
    template<class Value>
    __device__ Value operator()(Value a, Value b) const
    {
        return a + b;
    }
};

struct LargerValue
{
    template<class Value>
    __device__ Value operator()(Value a, Value b) const
    {
        return a > b ? a : b;
    }
};

/// Number of lanes of a warp that hold one of `width` combined values.
template<int width>
constexpr int lanes_a_slot = warp_size / static_cast<int>(std::bit_ceil(static_cast<unsigned>(width)));

/// Index of the value that lane `lane` holds after warp_combine.
template<int width>
__device__ int warp_slot(int lane)
{
    return lane / lanes_a_slot<width>;
}

/// Whether a lane is the first of the lanes that hold its value.
template<int width>
__device__ bool is_slot_head(int lane)
{
    return lane % lanes_a_slot<width> == 0;
}

/// Combines the first `width` values of each lane of a warp in a fixed order; lane l receives value warp_slot(l). In
/// each exchange a lane passes on half of its values, so that 16 values need 16 exchanges instead of 80.
template<int width, class Value, class Combine>
__device__ Value warp_combine(const Value* values, Combine combine)
{
    constexpr int slots = warp_size / lanes_a_slot<width>;
    const int     lane  = static_cast<int>(threadIdx.x) % warp_size;
    Value         part[slots];
#pragma unroll
    for (int w = 0; w < slots; ++w) { part[w] = w < width ? values[w] : Value(0); }
    constexpr int steps = 5, halvings = std::countr_zero(static_cast<unsigned>(slots));
#pragma unroll
    for (int step = 0; step < steps; ++step)
    {
        const int  across = warp_size >> (step + 1), half = slots >> (step + 1);
        const bool upper = (lane & across) != 0;
        if (step >= halvings) { part[0] = combine(part[0], __shfl_xor_sync(all_lanes, part[0], across)); }
#pragma unroll
        for (int w = 0; w < half; ++w)
        {
            const Value kept = upper ? part[w + half] : part[w], handed = upper ? part[w] : part[w + half];
            part[w] = combine(kept, __shfl_xor_sync(all_lanes, handed, across));
        }
    }
    return part[0];
}

/// Combines `width` values of each of a block's `threads` threads in a fixed order: warp_combine first, then the warps
/// sequentially in fp64. Calls keep(which, value) from thread `which` of the block. `shared` holds threads / 32 * width
/// doubles that nothing else uses meanwhile. All threads must call it.
template<int threads, int width, class Value, class Combine, class Keep>
__device__ void block_combine(const Value* values, double* shared, Combine combine, Keep keep)
{
    constexpr int warps = threads / warp_size;
    const int     lane = static_cast<int>(threadIdx.x) % warp_size, warp = static_cast<int>(threadIdx.x) / warp_size;
    const Value   value = warp_combine<width>(values, combine);
    const int     which = warp_slot<width>(lane);
    if (which < width && is_slot_head<width>(lane)) { shared[warp * width + which] = static_cast<double>(value); }
    __syncthreads();
    if (threadIdx.x < width)
    {
        double total = shared[threadIdx.x];
        for (int w = 1; w < warps; ++w) { total = combine(total, shared[w * width + threadIdx.x]); }
        keep(static_cast<int>(threadIdx.x), total);
    }
}

template<int threads, int width, class Value, class Keep>
__device__ void block_sum(const Value* values, double* shared, Keep keep)
{
    block_combine<threads, width>(values, shared, AddValues{}, keep);
}

template<int threads, int width, class Value, class Keep>
__device__ void block_largest(const Value* values, double* shared, Keep keep)
{
    block_combine<threads, width>(values, shared, LargerValue{}, keep);
}

} // namespace tread
