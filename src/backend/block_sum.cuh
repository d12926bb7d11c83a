#pragma once

#include "backend/warp.cuh"

namespace tread
{

struct AddValues
{
    __device__ double operator()(double a, double b) const { return a + b; }
};

struct LargerValue
{
    __device__ double operator()(double a, double b) const { return a > b ? a : b; }
};

/// Combines `width` values of each of a block's `threads` threads in a fixed order: a tree in each warp, then the warps
/// one after the other; 0 combined with 0 must give 0. Calls keep(which, value) from thread `which` of the block.
/// `shared` holds threads / 32 * width doubles, not in use by others. All threads must call it.
template<int threads, int width, class Value, class Combine, class Keep>
__device__ void block_combine(const Value* values, double* shared, Combine combine, Keep keep)
{
    constexpr int warps = threads / 32;
    for (int w = 0; w < width; ++w)
    {
        double value = static_cast<double>(values[w]);
        if (__any_sync(all_lanes, value != 0)) // many sums are zero on most pages
        {
            for (int half = 16; half > 0; half /= 2)
            {
                value = combine(value, __shfl_xor_sync(all_lanes, value, half));
            }
        }
        if (threadIdx.x % 32 == 0) { shared[threadIdx.x / 32 * width + w] = value; }
    }
    __syncthreads();
    if (threadIdx.x < width)
    {
        double value = shared[threadIdx.x];
        for (int warp = 1; warp < warps; ++warp) { value = combine(value, shared[warp * width + threadIdx.x]); }
        keep(static_cast<int>(threadIdx.x), value);
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
