#pragma once

#include "backend/launch.cuh"
#include "kernels/contact/runs.hpp"
#include "kernels/dem/contact/warp_lanes.cuh"

namespace tread::contact
{

/// Raw storage for one value per thread, because static shared memory must not run constructors.
template<class Sum, int threads>
struct BlockStorage
{
    alignas(Sum) unsigned char bytes[threads * sizeof(Sum)];

    __device__ Sum* values() { return reinterpret_cast<Sum*>(bytes); }
};

template<class Sum, class Item, class Finish, int threads>
struct ReduceRun
{
    RunsView runs;
    Item     item;
    Finish   finish;

    __device__ void operator()(std::int64_t run) const
    {
        __shared__ BlockStorage<Sum, threads> storage;
        const int                             thread  = static_cast<int>(threadIdx.x);
        Sum*                                  partial = storage.values();

        Sum sum = Sum::zero();
        for (std::int64_t i = runs.first[run] + thread; i < runs.first[run + 1]; i += threads) { sum = sum + item(i); }
        partial[thread] = sum;
        for (int half = threads / 2; half > 0; half /= 2)
        {
            __syncthreads();
            if (thread < half) { partial[thread] = partial[thread] + partial[thread + half]; }
        }
        if (thread == 0) { finish(run, partial[0]); }
    }
};

/// Calls finish(r, sum over its items i of item(i)) for every run r. One block per run: its threads stride over the
/// items, then a tree sums the threads, in a fixed order. Sum needs operator+ and zero().
template<class Sum, class Item, class Finish>
void reduce_runs(const Gpu& gpu, const char* name, const RunsView& runs, Item item, Finish finish)
{
    constexpr int threads = 128;
    for_each_block<threads>(gpu, name, runs.count, ReduceRun<Sum, Item, Finish, threads>{runs, item, finish});
}

/// Calls f(r, lanes) for every run r; runs are short.
template<class F>
void for_each_run(const Gpu& gpu, const char* name, const RunsView& runs, F f)
{
    dem::for_each_group<part_lanes>(gpu, name, runs.count, f);
}

} // namespace tread::contact
