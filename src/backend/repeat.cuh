#pragma once

#include <algorithm>
#include <cstdint>

#include "backend/cooperative.cuh"

// Runs a sequence of parts many times in one launch. Where each part takes only a few microseconds, separate launches
// would double the cost.
namespace tread
{

/// Runs f(block) for blocks with as many threads as the sequence has. Blocks may use shared memory and barriers, as in
/// for_each_block.
template<class F>
struct Part
{
    std::int64_t blocks;
    F            f;
};

template<class F>
Part(std::int64_t, F) -> Part<F>;

/// Runs f(i) for i in [0, n), one item per thread.
template<int threads, class F>
struct ItemsOfBlock
{
    F            f;
    std::int64_t n;

    __device__ void operator()(std::int64_t block) const
    {
        const std::int64_t i = block * threads + threadIdx.x;
        if (i < n) { f(i); }
    }
};

template<int threads, class F>
Part<ItemsOfBlock<threads, F>> items(std::int64_t n, const F& f)
{
    return {(n + threads - 1) / threads, {f, n}};
}

/// Two parts that are independent of each other.
template<class First, class Second>
struct Beside
{
    std::int64_t first_blocks;
    First        first;
    Second       second;

    __device__ void operator()(std::int64_t block) const
    {
        if (block < first_blocks) { first(block); }
        else { second(block - first_blocks); }
    }
};

template<class First, class Second>
Part<Beside<First, Second>> beside(const Part<First>& first, const Part<Second>& second)
{
    return {first.blocks + second.blocks, {first.blocks, first.f, second.f}};
}

template<class... Parts>
struct Sequence
{
    std::int64_t most_blocks() const { return 0; }

    __device__ void run(const cooperative_groups::grid_group&) const {}
};

template<class First, class... Rest>
struct Sequence<First, Rest...>
{
    First             first;
    Sequence<Rest...> rest;

    std::int64_t most_blocks() const { return std::max(first.blocks, rest.most_blocks()); }

    /// Runs each part after the previous one has finished; a part without blocks costs nothing.
    __device__ void run(const cooperative_groups::grid_group& grid) const
    {
        if (first.blocks > 0)
        {
            for (std::int64_t block = blockIdx.x; block < first.blocks; block += gridDim.x)
            {
                first.f(block);
                __syncthreads(); // the next block reuses the shared memory
            }
            grid.sync();
        }
        rest.run(grid);
    }
};

inline Sequence<> sequence() { return {}; }

template<class First, class... Rest>
Sequence<First, Rest...> sequence(const First& first, const Rest&... rest)
{
    return {first, sequence(rest...)};
}

/// Numbers of the times that a sequence is run, and an end to them.
struct Times
{
    std::int64_t        count;
    std::int32_t        before  = 0;       ///< the first time has the number before + 1
    std::int32_t*       present = nullptr; ///< null, or in the device's memory: receives the number of each time
    const std::int32_t* last    = nullptr; ///< null, or there: number of the last time, which parts may set; 0: none
};

template<int threads, int blocks_an_sm, class Parts>
__global__ void __launch_bounds__(threads, blocks_an_sm)
    repeat_kernel(const __grid_constant__ Times times, const __grid_constant__ Parts parts)
{
    const auto grid = cooperative_groups::this_grid();
    for (std::int32_t number = times.before + 1; number <= times.before + times.count; ++number)
    {
        if (times.present != nullptr && blockIdx.x == 0 && threadIdx.x == 0) { *times.present = number; }
        parts.run(grid);
        if (times.last == nullptr) { continue; }
        const std::int32_t last = *static_cast<volatile const std::int32_t*>(times.last);
        if (last != 0 && number >= last) { return; }
    }
}

/// Runs the sequence several times in one cooperative launch with at most as many blocks as are resident on the device.
/// Parts may read times.present, and the last one may write times.last, only where another part with blocks comes
/// before it: then no block is at it before all have read what it left there the time before.
template<int threads, int blocks_an_sm, class Parts>
void repeat(const Gpu& gpu, const char* name, const Times& times, const Parts& parts)
{
    const std::int64_t wanted = parts.most_blocks();
    if (wanted == 0 || times.count == 0) { return; }
    const auto kernel = repeat_kernel<threads, blocks_an_sm, Parts>;
    launch_together(gpu, name, kernel, std::min(wanted, resident_blocks(name, kernel, threads)), threads, times, parts);
}

} // namespace tread
