#pragma once

#include <bit>
#include <cstdint>

#include "backend/vector.hpp"

// Sets of up to 32 elements, one bit each.
namespace tread
{

TREAD_HD int count_bits(std::uint32_t bits)
{
#if defined(__CUDA_ARCH__)
    return __popc(bits);
#else
    return std::popcount(bits);
#endif
}

/// Returns the index of the lowest set bit; `bits` must not be 0.
TREAD_HD int lowest_bit(std::uint32_t bits)
{
#if defined(__CUDA_ARCH__)
    return __ffs(static_cast<int>(bits)) - 1;
#else
    return std::countr_zero(bits);
#endif
}

/// Returns a mask of the n lowest bits; all bits are set for n >= 32.
TREAD_HD std::uint32_t first_bits(std::int32_t n) { return n < 32 ? (std::uint32_t{1} << n) - 1 : ~std::uint32_t{0}; }

} // namespace tread
