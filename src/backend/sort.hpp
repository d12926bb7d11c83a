#pragma once

#include <bit>
#include <cstdint>

#include "backend/array.hpp"

// Sorts and scans of integers: the standard library on the CPU, CUB on the GPU. Results are independent of thread
// counts.
namespace tread
{

/// Scratch memory of sort_by_key and scans, kept between calls.
template<class Exec>
struct SortScratch
{
    explicit SortScratch(const Exec& exec)
        : bytes(exec, "sort scratch")
        , keys(exec, "sort scratch keys")
        , values(exec, "sort scratch values")
        , ends(exec, "scan ends")
    {
    }

    Array<Exec, unsigned char> bytes;
    Array<Exec, std::uint64_t> keys;
    Array<Exec, std::int32_t>  values;
    Array<Exec, std::int32_t>  ends; ///< last value of a scan's input and of its output
};

/// Number of bits that distinguish the numbers below `count`.
inline int bits_below(std::int64_t count)
{
    return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(count)));
}

/// Sorts both arrays by key, stably. Takes n < 2^31 keys; values after the n-th are left as they are. Keys must be
/// below 2^bits: a GPU's radix sort handles eight bits per pass.
void sort_by_key(const Cpu&, Array<Cpu, std::uint64_t>& keys, Array<Cpu, std::int32_t>& values, SortScratch<Cpu>&,
                 int bits = 64);
void sort_by_key(const Gpu&, Array<Gpu, std::uint64_t>& keys, Array<Gpu, std::int32_t>& values, SortScratch<Gpu>&,
                 int bits = 64);

/// Exclusive prefix sum in place: values[i] becomes the sum of the values before i.
void scan_in_place(const Cpu&, Array<Cpu, std::int32_t>& values, SortScratch<Cpu>&);
void scan_in_place(const Gpu&, Array<Gpu, std::int32_t>& values, SortScratch<Gpu>&);

/// Exclusive prefix sum in place; returns the total, for which it waits. Throws a NumericalError that names the total
/// if it exceeds 2^31 - 1; the GPU detects this only for totals below 2^32.
std::int64_t exclusive_scan(const Cpu&, Array<Cpu, std::int32_t>& values, SortScratch<Cpu>&);
std::int64_t exclusive_scan(const Gpu&, Array<Gpu, std::int32_t>& values, SortScratch<Gpu>&);

/// First index in the sorted range whose value is not less than `key`.
template<class T>
TREAD_HD std::int64_t lower_bound(const T* sorted, std::int64_t count, T key)
{
    std::int64_t low = 0;
    while (count > 0)
    {
        const std::int64_t half = count / 2;
        if (sorted[low + half] < key)
        {
            low += half + 1;
            count -= half + 1;
        }
        else { count = half; }
    }
    return low;
}

/// Index of `key` in the sorted range, or -1.
template<class T>
TREAD_HD std::int64_t find_sorted(const T* sorted, std::int64_t count, T key)
{
    const std::int64_t at = lower_bound(sorted, count, key);
    return at < count && sorted[at] == key ? at : -1;
}

} // namespace tread
