#pragma once

#include <cstddef>
#include <cstdint>

#include "backend/execution.hpp"
#include "base/errors.hpp"

// Raw memory of a backend. Array is the owner; nothing else calls allocate and release.
namespace tread
{

/// Memory for what `name` says; out_of_memory when there is not enough.
void* allocate(const Cpu&, const char* name, std::size_t bytes);
void* allocate(const Gpu&, const char* name, std::size_t bytes);

/// Bytes that the backend's memory still has, of this and of all other processes.
std::int64_t free_bytes(const Cpu&);
std::int64_t free_bytes(const Gpu&);

/// What did not fit into `memory` ("host", "device"), how much is free, what the run holds and wants in all.
EnvironmentError out_of_memory(const char* memory, const char* name, std::size_t bytes, std::int64_t free,
                               const Counters& counters);

void release(const Cpu&, void* memory);
void release(const Gpu&, void* memory);

void fill_zero(const Cpu&, void* memory, std::size_t bytes);
void fill_zero(const Gpu&, void* memory, std::size_t bytes);

/// Within the backend's own memory.
void copy(const Cpu&, void* to, const void* from, std::size_t bytes);
void copy(const Gpu&, void* to, const void* from, std::size_t bytes);

/// Returns when the bytes have arrived.
void copy_to_host(const Cpu&, void* to, const void* from, std::size_t bytes);
void copy_to_host(const Gpu&, void* to, const void* from, std::size_t bytes);

/// The bytes have arrived after the next synchronize; `to` is memory that the device reaches (Pinned).
void start_copy_to_host(const Cpu&, void* to, const void* from, std::size_t bytes);
void start_copy_to_host(const Gpu&, void* to, const void* from, std::size_t bytes);

void copy_from_host(const Cpu&, void* to, const void* from, std::size_t bytes);
void copy_from_host(const Gpu&, void* to, const void* from, std::size_t bytes);

/// Waits for everything that was launched; throws NumericalError or EnvironmentError on a device fault.
void synchronize(const Cpu&);
void synchronize(const Gpu&);

} // namespace tread
