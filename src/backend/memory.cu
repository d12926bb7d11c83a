#include "backend/cuda_check.cuh"
#include "backend/memory.hpp"

namespace tread
{

void* allocate(const Gpu&, std::size_t bytes)
{
    void*             memory = nullptr;
    const cudaError_t status = cudaMalloc(&memory, bytes);
    if (status == cudaErrorMemoryAllocation)
    {
        std::size_t free = 0, total = 0;
        cudaMemGetInfo(&free, &total);
        throw EnvironmentError("out of device memory: " + std::to_string(bytes) + " bytes wanted at once, " +
                               std::to_string(free) + " of " + std::to_string(total) + " free");
    }
    check_cuda(status, "cudaMalloc");
    return memory;
}

void release(const Gpu&, void* memory) { cudaFree(memory); }

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
    check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, gpu.stream), "copy to the host");
    synchronize(gpu);
}

void copy_from_host(const Gpu& gpu, void* to, const void* from, std::size_t bytes)
{
    if (bytes == 0) { return; }
    check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, gpu.stream), "copy to the device");
    synchronize(gpu);
}

void synchronize(const Gpu& gpu) { check_cuda(cudaStreamSynchronize(gpu.stream), "synchronize"); }

} // namespace tread
