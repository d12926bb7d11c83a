#pragma once

#include <cstdint>

#include "backend/counters.hpp"
#include "backend/cuda_check.cuh"
#include "backend/execution.hpp"

namespace tread
{

/// First in every kernel: the next one may be brought to the multiprocessors as they become free; this one waits for
/// all that the one before it has written ("programmatic dependent launch").
__device__ inline void take_turn()
{
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
    cudaTriggerProgrammaticLaunchCompletion();
    cudaGridDependencySynchronize();
#endif
}

template<class F>
__global__ void for_each_kernel(std::int64_t n, const __grid_constant__ F f)
{
    take_turn();
    const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
    if (i < n) { f(i); }
}

/// Launches a kernel that begins with take_turn().
template<class... Parameters, class... Arguments>
void launch(const Gpu& gpu, const char* name, void (*kernel)(Parameters...), std::int64_t blocks, int threads,
            const Arguments&... arguments)
{
    gpu.counters->launched(name);
    cudaLaunchAttribute overlap{};
    overlap.id                                         = cudaLaunchAttributeProgrammaticStreamSerialization;
    overlap.val.programmaticStreamSerializationAllowed = 1;
    cudaLaunchConfig_t how{};
    how.gridDim  = dim3(static_cast<unsigned>(blocks));
    how.blockDim = dim3(static_cast<unsigned>(threads));
    how.stream   = gpu.stream;
    how.attrs    = &overlap;
    how.numAttrs = gpu.overlaps_launches ? 1 : 0;
    check_cuda(cudaLaunchKernelEx(&how, kernel, arguments...), name);
}

/// Runs f(i) for i in [0, n), one thread an item.
template<class F>
void for_each(const Gpu& gpu, const char* name, std::int64_t n, F f)
{
    if (n == 0) { return; }
    constexpr int threads = 128;
    launch(gpu, name, for_each_kernel<F>, (n + threads - 1) / threads, threads, n, f);
}

template<int threads, int blocks_an_sm, class F>
__global__ void __launch_bounds__(threads, blocks_an_sm) for_each_block_kernel(const __grid_constant__ F f)
{
    take_turn();
    f(static_cast<std::int64_t>(blockIdx.x));
}

/// Runs f(block) with `threads` threads a block, for bodies that share memory and barriers. `blocks_an_sm` caps the
/// registers so that that many fit.
template<int threads, int blocks_an_sm = 1, class F>
void for_each_block(const Gpu& gpu, const char* name, std::int64_t blocks, F f)
{
    if (blocks == 0) { return; }
    launch(gpu, name, for_each_block_kernel<threads, blocks_an_sm, F>, blocks, threads, f);
}

} // namespace tread
