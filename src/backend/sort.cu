#include <array>

#include <cub/cub.cuh>

#include "backend/count_limit.hpp"
#include "backend/cuda_check.cuh"
#include "backend/sort.hpp"

namespace tread
{

void sort_by_key(const Gpu& gpu, Array<Gpu, std::uint64_t>& keys, Array<Gpu, std::int32_t>& values,
                 SortScratch<Gpu>& scratch, int bits)
{
    const std::int64_t n = keys.size();
    if (n == 0) { return; }
    gpu.counters->launched("sort");
    scratch.keys.resize(n);
    scratch.values.resize(n);
    const int   count = static_cast<int>(n);
    std::size_t bytes = 0;
    check_cuda(cub::DeviceRadixSort::SortPairs(nullptr, bytes, keys.data(), scratch.keys.data(), values.data(),
                                               scratch.values.data(), count, 0, bits, gpu.stream),
               "sort");
    scratch.bytes.resize(static_cast<std::int64_t>(bytes));
    check_cuda(cub::DeviceRadixSort::SortPairs(scratch.bytes.data(), bytes, keys.data(), scratch.keys.data(),
                                               values.data(), scratch.values.data(), count, 0, bits, gpu.stream),
               "sort");
    keys.swap(scratch.keys);
    copy(gpu, values.data(), scratch.values.data(), static_cast<std::size_t>(n) * sizeof(std::int32_t));
}

void scan_in_place(const Gpu& gpu, Array<Gpu, std::int32_t>& values, SortScratch<Gpu>& scratch)
{
    if (values.size() == 0) { return; }
    gpu.counters->launched("scan");
    const int   count = static_cast<int>(values.size());
    std::size_t bytes = 0;
    check_cuda(cub::DeviceScan::ExclusiveSum(nullptr, bytes, values.data(), values.data(), count, gpu.stream), "scan");
    scratch.bytes.resize(static_cast<std::int64_t>(bytes));
    check_cuda(
        cub::DeviceScan::ExclusiveSum(scratch.bytes.data(), bytes, values.data(), values.data(), count, gpu.stream),
        "scan");
}

std::int64_t exclusive_scan(const Gpu& gpu, Array<Gpu, std::int32_t>& values, SortScratch<Gpu>& scratch)
{
    const std::int64_t n = values.size();
    if (n == 0) { return 0; }
    scratch.ends.resize(2);
    std::int32_t* ends = scratch.ends.data();
    copy(gpu, ends, values.data() + n - 1, sizeof(std::int32_t));
    scan_in_place(gpu, values, scratch);
    copy(gpu, ends + 1, values.data() + n - 1, sizeof(std::int32_t));
    const auto both = read(gpu, reinterpret_cast<const std::array<std::uint32_t, 2>*>(ends)); // one wait for both
    const std::uint32_t sum = both[0] + both[1];                                              // wraps around at 2^32
    require_countable(sum);
    return sum;
}

} // namespace tread
