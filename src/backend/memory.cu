#include "backend/counters.hpp"
#include "backend/cuda_check.cuh"
#include "backend/memory.hpp"

namespace tread
{
namespace
{

cudaMemPool_t memory_pool()
{
    int           device = 0;
    cudaMemPool_t pool   = nullptr;
    check_cuda(cudaGetDevice(&device), "choice of the device");
    check_cuda(cudaDeviceGetDefaultMemPool(&pool, device), "pool of memory");
    return pool;
}

} // namespace

std::int64_t free_bytes(const Gpu&)
{
    std::size_t   free = 0, total = 0;
    std::uint64_t reserved = 0, used = 0;
    check_cuda(cudaMemGetInfo(&free, &total), "memory of the device");
    const cudaMemPool_t pool = memory_pool();
    check_cuda(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrReservedMemCurrent, &reserved), "pool of memory");
    check_cuda(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrUsedMemCurrent, &used), "pool of memory");
    return static_cast<std::int64_t>(free + reserved - used);
}

void* allocate(const Gpu& gpu, const char* name, std::size_t bytes)
{
    void*             memory  = nullptr;
    const bool        allowed = gpu.counters->has_room(static_cast<std::int64_t>(bytes));
    const cudaError_t status  = allowed ? cudaMallocAsync(&memory, bytes, gpu.stream) : cudaErrorMemoryAllocation;
    if (status == cudaErrorMemoryAllocation)
    {
        cudaGetLastError(); // clears the error: the run ends with a typed error for lack of memory
        throw out_of_memory("device", name, bytes, free_bytes(gpu), *gpu.counters);
    }
    check_cuda(status, "cudaMallocAsync");
    return memory;
}

void release(const Gpu& gpu, void* memory) { cudaFreeAsync(memory, gpu.stream); }

void fill_zero(const Gpu& gpu, void* memory, std::size_t bytes)
{
    if (bytes > 0) { check_cuda(cudaMemsetAsync(memory, 0, bytes, gpu.stream), "cudaMemsetAsync"); }
}

void copy(const Gpu& gpu, void* to, const void* from, std::size_t bytes)
{
    if (bytes > 0)
    {
        check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, gpu.stream), "copy on the device");
    }
}

void copy_to_host(const Gpu& gpu, void* to, const void* from, std::size_t bytes)
{
    if (bytes == 0) { return; }
    start_copy_to_host(gpu, to, from, bytes);
    synchronize(gpu);
}

void start_copy_to_host(const Gpu& gpu, void* to, const void* from, std::size_t bytes)
{
    check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, gpu.stream), "copy to the host");
}

void copy_from_host(const Gpu& gpu, void* to, const void* from, std::size_t bytes)
{
    if (bytes == 0) { return; }
    check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, gpu.stream), "copy to the device");
    synchronize(gpu);
}

void synchronize(const Gpu& gpu) { check_cuda(cudaStreamSynchronize(gpu.stream), "synchronize"); }

} // namespace tread
