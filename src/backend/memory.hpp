#pragma once

#include <cstddef>
#include <cstdint>

#include "backend/execution.hpp"
#include "base/errors.hpp"

// Raw memory of a backend. Arrays own it; nothing else calls allocate and release.
namespace tread
{

/// Allocates memory under the name `name`; throws out_of_memory if there is not enough.
void* allocate(const Cpu&, const char* name, std::size_t bytes);
void* allocate(const Gpu&, const char* name, std::size_t bytes);

/// Bytes of the backend's memory that are free, with all processes counted.
std::int64_t free_bytes(const Cpu&);
std::int64_t free_bytes(const Gpu&);

/// Makes the error of an allocation that does not fit into `memory` ("host", "device"): its name, the free bytes, what
/// the run holds and its estimated total.
EnvironmentError out_of_memory(const char* memory, const char* name, std::size_t bytes, std::int64_t free,
                               const Counters& counters);

void release(const Cpu&, void* memory);
void release(const Gpu&, void* memory);

void fill_zero(const Cpu&, void* memory, std::size_t bytes);
void fill_zero(const Gpu&, void* memory, std::size_t bytes);

/// Copies within the backend's own memory.
void copy(const Cpu&, void* to, const void* from, std::size_t bytes);
void copy(const Gpu&, void* to, const void* from, std::size_t bytes);

/// Copies to the host; returns when the bytes have arrived.
void copy_to_host(const Cpu&, void* to, const void* from, std::size_t bytes);
void copy_to_host(const Gpu&, void* to, const void* from, std::size_t bytes);

/// Starts a copy to the host. The bytes have arrived after the next synchronize; `to` must be accessible by the device
/// (Pinned).
void start_copy_to_host(const Cpu&, void* to, const void* from, std::size_t bytes);
void start_copy_to_host(const Gpu&, void* to, const void* from, std::size_t bytes);

void copy_from_host(const Cpu&, void* to, const void* from, std::size_t bytes);
void copy_from_host(const Gpu&, void* to, const void* from, std::size_t bytes);

/// Waits for everything launched so far; throws NumericalError or EnvironmentError on a device fault.
void synchronize(const Cpu&);
void synchronize(const Gpu&);

} // namespace tread
