#pragma once

#include "backend/launch.cuh"
#include "kernels/contact/runs.hpp"
#include "kernels/dem/contact/warp_lanes.cuh"

// Loops over contacts (contact_loops.hpp), on a GPU.
namespace tread::contact
{

/// Raw storage for one value per thread, because static shared memory must not run constructors.
template<class Sum, int threads>
struct BlockStorage
{
    alignas(Sum) unsigned char bytes[threads * sizeof(Sum)];

    __device__ Sum* values() { return reinterpret_cast<Sum*>(bytes); }
};

template<class Sum, class Item, int threads>
struct SumChunk
{
    Item         item;
    std::int64_t count;
    std::int64_t size;
    Sum*         sums;

    __device__ void operator()(std::int64_t chunk) const
    {
        __shared__ BlockStorage<Sum, threads> storage;
        const int                             thread  = static_cast<int>(threadIdx.x);
        Sum*                                  partial = storage.values();

        const std::int64_t end = min(count, (chunk + 1) * size);
        Sum                sum = Sum::zero();
        for (std::int64_t i = chunk * size + thread; i < end; i += threads) { sum = sum + item(i); }
        partial[thread] = sum;
        for (int half = threads / 2; half > 0; half /= 2)
        {
            __syncthreads();
            if (thread < half) { partial[thread] = partial[thread] + partial[thread + half]; }
        }
        if (thread == 0) { sums[chunk] = partial[0]; }
    }
};

/// Computes sums[c] = sum of item(i) over the items of chunk c, `size` each of `count`. A block a chunk: its threads
/// stride over the items, then a tree sums the threads, in a fixed order. Sum needs operator+ and zero().
template<class Sum, class Item>
void sum_chunks(const Gpu& gpu, const char* name, std::int64_t count, std::int64_t size, Item item, Sum* sums)
{
    constexpr int threads = 128;
    for_each_block<threads>(gpu, name, chunks_of(count, size), SumChunk<Sum, Item, threads>{item, count, size, sums});
}

/// Calls f(r, lanes) for every run r; runs are short.
template<class F>
void for_each_run(const Gpu& gpu, const char* name, const RunsView& runs, F f)
{
    dem::for_each_group<part_lanes>(gpu, name, runs.count, f);
}

} // namespace tread::contact
