#pragma once

#include <bit>
#include <cstdint>

#include "backend/vector.hpp"

// Sets of up to 32 things, a bit each.
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

/// Of a set that is not empty.
TREAD_HD int lowest_bit(std::uint32_t bits)
{
#if defined(__CUDA_ARCH__)
    return __ffs(static_cast<int>(bits)) - 1;
#else
    return std::countr_zero(bits);
#endif
}

/// The first n, all of them from 32 on.
TREAD_HD std::uint32_t first_bits(std::int32_t n) { return n < 32 ? (std::uint32_t{1} << n) - 1 : ~std::uint32_t{0}; }

} // namespace tread
