#pragma once

#include <cstdint>

// Marks item functions (the physics of one point, node, body or contact), which are written once and compiled for both
// backends.
#if defined(__CUDACC__)
#define TREAD_HD __host__ __device__ __forceinline__
#else
#define TREAD_HD inline __attribute__((always_inline))
#endif

struct CUstream_st; // cudaStream_t without CUDA's headers

namespace tread
{

class Counters;

/// Execution tag, the first argument of every function that runs on a backend: OpenMP threads of this process.
struct Cpu
{
    Counters*           counters;
    const std::int32_t* skip = nullptr; ///< launches do nothing while it points to anything but 0
};

/// Execution tag: one CUDA device; all work runs in order on one stream.
struct Gpu
{
    CUstream_st*        stream;
    Counters*           counters;
    const std::int32_t* skip = nullptr; ///< as in Cpu, on the device: work that was requested in advance may be dropped
};

} // namespace tread
