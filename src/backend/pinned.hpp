#pragma once

#include <cstddef>
#include <utility>

#include "backend/execution.hpp"

namespace tread
{

/// Tag of Array: pinned host memory that kernels of any device and MPI can read and write.
struct Pinned
{
    Counters* counters;
};

void* allocate(const Pinned&, const char* name, std::size_t bytes);
void  release(const Pinned&, void* memory);

/// Returns the host's tag of a backend: its arrays receive asynchronous copies (pinned memory for a GPU).
inline Cpu    host_side(const Cpu& cpu) { return cpu; }
inline Pinned host_side(const Gpu& gpu) { return {gpu.counters}; }

/// Returns the same, with memory that a GPU's copies need counted in `host`, not as memory of the device.
inline Cpu    host_side(const Cpu& cpu, Counters&) { return cpu; }
inline Pinned host_side(const Gpu&, Counters& host) { return {&host}; }

/// Type of host_side.
template<class Exec>
using HostSide = decltype(host_side(std::declval<Exec>()));

} // namespace tread
