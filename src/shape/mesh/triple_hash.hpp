#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tread::shape
{

/// Hash of three 64-bit numbers; equal numbers must have equal bits (so -0.0 and 0.0 must not mix).
struct TripleHash
{
    template<class T>
    std::size_t operator()(const std::array<T, 3>& triple) const
    {
        std::uint64_t mixed = 0;
        for (const T& part : triple)
        {
            // An odd factor near 2^64 over the golden ratio mixes low bits, the shift brings high ones down.
            mixed = (mixed ^ std::bit_cast<std::uint64_t>(part)) * 0x9e3779b97f4a7c15u;
            mixed ^= mixed >> 29;
        }
        return mixed;
    }
};

} // namespace tread::shape
