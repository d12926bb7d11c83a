#pragma once

#include <atomic>
#include <cstdint>

#include "backend/execution.hpp"

// What threads agree on while they run side by side. Integers only: a floating-point sum would depend on who comes
// first.
namespace tread
{

/// Puts `wanted` where `expected` stands, and nothing where another value does; what stood there before. Orders no
/// other memory: what else the winner writes is seen after the launch.
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

} // namespace tread
