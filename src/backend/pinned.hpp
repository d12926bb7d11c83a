#pragma once

#include <cstddef>

#include "backend/execution.hpp"

// Only in builds with a CUDA compiler (TREAD_WITH_CUDA).
namespace tread
{

/// Host memory that the kernels of any device and MPI can both read and write. A tag for Array.
struct Pinned
{
    Counters* counters;
};

void* allocate(const Pinned&, const char* name, std::size_t bytes);
void  release(const Pinned&, void* memory);

} // namespace tread
