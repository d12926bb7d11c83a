#pragma once

#include <atomic>
#include <cstdint>

#include "backend/execution.hpp"

// Atomic operations on integers. There are none for floating-point numbers, because their sums would depend on the
// order of the threads.
namespace tread
{

/// Writes `wanted` if `expected` is stored, and leaves any other value; returns the previous value. Orders no other
/// memory accesses: other writes of the winning thread are visible only after the launch.
TREAD_HD std::uint64_t compare_and_swap(std::uint64_t* at, std::uint64_t expected, std::uint64_t wanted)
{
#if defined(__CUDA_ARCH__)
    static_assert(sizeof(unsigned long long) == sizeof(std::uint64_t));
    return atomicCAS(reinterpret_cast<unsigned long long*>(at), expected, wanted);
#else
    std::atomic_ref<std::uint64_t>(*at).compare_exchange_strong(expected, wanted, std::memory_order_relaxed);
    return expected;
#endif
}

/// Reads a value that other threads of the same launch may write.
TREAD_HD std::int32_t load_together(const std::int32_t* at)
{
#if defined(__CUDA_ARCH__)
    return *static_cast<const volatile std::int32_t*>(at);
#else
    return std::atomic_ref<const std::int32_t>(*at).load(std::memory_order_relaxed);
#endif
}

/// Writes a value that other threads of the same launch may write as well.
TREAD_HD void store_together(std::int32_t* at, std::int32_t value)
{
#if defined(__CUDA_ARCH__)
    *static_cast<volatile std::int32_t*>(at) = value;
#else
    std::atomic_ref<std::int32_t>(*at).store(value, std::memory_order_relaxed);
#endif
}

} // namespace tread
