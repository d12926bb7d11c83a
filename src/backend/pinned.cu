#include "backend/pinned.hpp"

#include "backend/counters.hpp"
#include "backend/cuda_check.cuh"
#include "backend/memory.hpp"

namespace tread
{

void* allocate(const Pinned& pinned, const char* name, std::size_t bytes)
{
    void*             memory = nullptr;
    const cudaError_t status = cudaHostAlloc(&memory, bytes, cudaHostAllocPortable | cudaHostAllocMapped);
    if (status == cudaErrorMemoryAllocation)
    {
        cudaGetLastError(); // clears the error: the run ends with a typed error for lack of memory
        throw out_of_memory("pinned host", name, bytes, free_bytes(Cpu{pinned.counters}), *pinned.counters);
    }
    check_cuda(status, "cudaHostAlloc");
    return memory;
}

void release(const Pinned&, void* memory) { cudaFreeHost(memory); }

} // namespace tread
