#pragma once

#include <cstddef>

#include "backend/execution.hpp"

// Raw memory of a backend. Array is the owner; nothing else calls allocate and release.
namespace tread
{

/// Throws EnvironmentError with the size wanted and the size free when there is not enough.
void* allocate(const Cpu&, std::size_t bytes);
void* allocate(const Gpu&, std::size_t bytes);

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

void copy_from_host(const Cpu&, void* to, const void* from, std::size_t bytes);
void copy_from_host(const Gpu&, void* to, const void* from, std::size_t bytes);

/// Waits for everything that was launched; throws NumericalError or EnvironmentError on a device fault.
void synchronize(const Cpu&);
void synchronize(const Gpu&);

} // namespace tread
