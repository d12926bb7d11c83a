#pragma once

#include <cstdint>

#include <cooperative_groups.h>

#include "backend/counters.hpp"
#include "backend/cuda_check.cuh"
#include "backend/execution.hpp"

// Cooperative kernels: blocks wait for each other, hence all of them must be resident on the device.
namespace tread
{

/// Returns the number of blocks of a kernel that are resident on the device together.
template<class Kernel>
std::int64_t resident_blocks(const char* name, Kernel kernel, int threads)
{
    int device = 0, processors = 0, resident = 0;
    check_cuda(cudaGetDevice(&device), name);
    check_cuda(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device), name);
    check_cuda(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&resident, kernel, threads, 0), name);
    return std::int64_t{processors} * resident;
}

/// Launches `blocks` blocks cooperatively; at most resident_blocks.
template<class... Parameters>
void launch_together(const Gpu& gpu, const char* name, void (*kernel)(Parameters...), std::int64_t blocks, int threads,
                     Parameters... parameters)
{
    gpu.counters->launched(name);
    void* arguments[] = {&parameters...};
    check_cuda(cudaLaunchCooperativeKernel(reinterpret_cast<const void*>(kernel), static_cast<unsigned>(blocks),
                                           threads, arguments, 0, gpu.stream),
               name);
}

} // namespace tread
