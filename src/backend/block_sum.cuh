#pragma once

namespace tread
{

/// Adds `width` values of each of a block's `threads` threads in a fixed tree; thread 0 writes the sums to `out`.
/// `shared` holds threads * width doubles. All threads must call it.
template<int threads, int width>
__device__ void block_sum(const double* values, double* shared, double* out)
{
    for (int w = 0; w < width; ++w) { shared[w * threads + threadIdx.x] = values[w]; }
    __syncthreads();
    for (unsigned half = threads / 2; half > 0; half /= 2)
    {
        if (threadIdx.x < half)
        {
            for (int w = 0; w < width; ++w)
            {
                shared[w * threads + threadIdx.x] += shared[w * threads + threadIdx.x + half];
            }
        }
        __syncthreads();
    }
    if (threadIdx.x < width) { out[threadIdx.x] = shared[threadIdx.x * threads]; }
}

} // namespace tread
