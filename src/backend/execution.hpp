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

/// Number of a launch that is requested before it is known whether it is due.
struct LaunchNumber
{
    const std::int32_t* last  = nullptr; ///< in the backend's memory: number of the last launch that is due; 0: all are
    std::int32_t        value = 0;

    TREAD_HD bool is_over() const { return last != nullptr && *last != 0 && value > *last; }
};

/// Execution tag, the first argument of every function that runs on a backend: OpenMP threads of this process.
struct Cpu
{
    Counters*    counters;
    LaunchNumber number = {}; ///< launches that are over do nothing
};

/// Execution tag: one CUDA device; all work runs in order on one stream.
struct Gpu
{
    CUstream_st* stream;
    Counters*    counters;
    LaunchNumber number = {}; ///< as in Cpu
};

} // namespace tread
