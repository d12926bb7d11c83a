#pragma once

#include <cstdint>

#include "backend/counters.hpp"
#include "backend/cuda_check.cuh"
#include "backend/execution.hpp"

// A kernel of few blocks is launched while the last one of its stream still runs, and waits for it: so it is ready to
// begin when that ends (programmatic dependent launch, from compute capability 9.0 on; docs/decisions/033).
namespace tread
{

/// Architecture from which on a kernel can wait for those before it.
inline constexpr int waits_from = 90;

/// Number of blocks up to which a kernel is launched early. Ten million points take 5 % longer if all are.
inline constexpr std::int64_t few_enough_to_wait = 1024;

/// Waits for all kernels before this one, and allows the next to be launched. Every kernel of this file begins with it.
__device__ inline void wait_for_last_kernel()
{
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.wait;" ::: "memory");
    asm volatile("griddepcontrol.launch_dependents;" ::: "memory");
#endif
}

/// Whether a kernel was compiled so that it waits.
template<class... Parameters>
bool waits(const char* name, void (*kernel)(Parameters...))
{
    cudaFuncAttributes found{};
    check_cuda(cudaFuncGetAttributes(&found, kernel), name);
    return found.ptxVersion >= waits_from;
}

/// Launches a kernel that begins with wait_for_last_kernel().
template<auto kernel, class... Parameters>
void launch_kernel(const Gpu& gpu, const char* name, std::int64_t blocks, int threads, const Parameters&... parameters)
{
    static const bool   may_wait = waits(name, kernel);
    cudaLaunchAttribute early{};
    early.id                                         = cudaLaunchAttributeProgrammaticStreamSerialization;
    early.val.programmaticStreamSerializationAllowed = 1;
    cudaLaunchConfig_t config{};
    config.gridDim  = dim3(static_cast<unsigned>(blocks));
    config.blockDim = dim3(static_cast<unsigned>(threads));
    config.stream   = gpu.stream;
    config.attrs    = &early;
    config.numAttrs = may_wait && blocks <= few_enough_to_wait ? 1 : 0;
    check_cuda(cudaLaunchKernelEx(&config, kernel, parameters...), name);
}

template<class F>
__global__ void for_each_kernel(LaunchNumber number, std::int64_t n, const __grid_constant__ F f)
{
    wait_for_last_kernel();
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
    launch_kernel<for_each_kernel<F>>(gpu, name, (n + threads - 1) / threads, threads, gpu.number, n, f);
}

template<int threads, int blocks_an_sm, class F>
__global__ void __launch_bounds__(threads, blocks_an_sm)
    for_each_block_kernel(LaunchNumber number, const __grid_constant__ F f)
{
    wait_for_last_kernel();
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
    launch_kernel<for_each_block_kernel<threads, blocks_an_sm, F>>(gpu, name, blocks, threads, gpu.number, f);
}

} // namespace tread
