#include <limits>

#include "backend/cuda_check.cuh"
#include "backend/device.hpp"

namespace tread
{

namespace
{

/// Keeps memory released by arrays in this process's pool: lists that are rebuilt reuse it immediately, in stream
/// order.
void keep_released_memory(int device)
{
    cudaMemPool_t pool      = nullptr;
    std::uint64_t threshold = std::numeric_limits<std::uint64_t>::max();
    check_cuda(cudaDeviceGetDefaultMemPool(&pool, device), "pool of memory");
    check_cuda(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &threshold), "pool of memory");
}

} // namespace

int device_count()
{
    int count = 0;
    return cudaGetDeviceCount(&count) == cudaSuccess ? count : 0;
}

DeviceFacts device_facts(int device)
{
    check_cuda(cudaSetDevice(device), "choice of the device");
    cudaDeviceProp properties{};
    check_cuda(cudaGetDeviceProperties(&properties, device), "properties of the device");
    std::size_t free = 0, total = 0;
    check_cuda(cudaMemGetInfo(&free, &total), "memory of the device");
    return {properties.name, std::string(properties.uuid.bytes, sizeof(properties.uuid.bytes)),
            static_cast<std::int64_t>(total), static_cast<std::int64_t>(free)};
}

Device::Device(int device, Counters& counters)
    : gpu_{nullptr, &counters}
{
    check_cuda(cudaSetDevice(device), "choice of the device");
    keep_released_memory(device);
    check_cuda(cudaStreamCreate(&gpu_.stream), "stream of the device");
}

Device::~Device() { cudaStreamDestroy(gpu_.stream); }

} // namespace tread
