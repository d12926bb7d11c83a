#pragma once

#include <cstdint>

#include "backend/counters.hpp"
#include "backend/cuda_check.cuh"
#include "backend/execution.hpp"

namespace tread
{

template<class F>
__global__ void for_each_kernel(LaunchNumber number, std::int64_t n, const __grid_constant__ F f)
{
    if (number.is_over()) { return; }
    const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
    if (i < n) { f(i); }
}

/// Runs f(i) for i in [0, n), one thread per item.
template<class F>
void for_each(const Gpu& gpu, const char* name, std::int64_t n, F f)
{
    if (n == 0) { return; }
    gpu.counters->launched(name);
    constexpr int threads = 128;
    for_each_kernel<<<static_cast<unsigned>((n + threads - 1) / threads), threads, 0, gpu.stream>>>(gpu.number, n, f);
    check_cuda(cudaGetLastError(), name);
}

template<int threads, int blocks_an_sm, class F>
__global__ void __launch_bounds__(threads, blocks_an_sm)
    for_each_block_kernel(LaunchNumber number, const __grid_constant__ F f)
{
    if (number.is_over()) { return; }
    f(static_cast<std::int64_t>(blockIdx.x));
}

/// Runs f(block) with `threads` threads per block, for functions that use shared memory and barriers. `blocks_an_sm`
/// limits the registers so that this many blocks fit on a multiprocessor.
template<int threads, int blocks_an_sm = 1, class F>
void for_each_block(const Gpu& gpu, const char* name, std::int64_t blocks, F f)
{
    if (blocks == 0) { return; }
    gpu.counters->launched(name);
    for_each_block_kernel<threads, blocks_an_sm>
        <<<static_cast<unsigned>(blocks), threads, 0, gpu.stream>>>(gpu.number, f);
    check_cuda(cudaGetLastError(), name);
}

} // namespace tread
