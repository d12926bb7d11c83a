#pragma once

#include <cstddef>

#include "backend/execution.hpp"

// Exists only in builds with a CUDA compiler (TREAD_WITH_CUDA).
namespace tread
{

/// Tag of Array: pinned host memory that kernels of any device and MPI can read and write.
struct Pinned
{
    Counters* counters;
};

void* allocate(const Pinned&, const char* name, std::size_t bytes);
void  release(const Pinned&, void* memory);

} // namespace tread
