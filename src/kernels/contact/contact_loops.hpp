#pragma once

#include <algorithm>

#include "backend/launch.hpp"
#include "kernels/contact/runs.hpp"
#include "kernels/dem/contact/body_field_kern.hpp"

// Loops over contacts, of which each backend has its own.
namespace tread::contact
{

/// Computes sums[c] = sum of item(i) over the items of chunk c, `size` each of `count`; sums have a fixed order. Sum
/// needs operator+ and zero().
template<class Sum, class Item>
void sum_chunks(const Cpu& cpu, const char* name, std::int64_t count, std::int64_t size, Item item, Sum* sums)
{
    for_each(cpu, name, chunks_of(count, size),
             [=](std::int64_t chunk)
             {
                 Sum sum = Sum::zero();
                 for (std::int64_t i = chunk * size; i < std::min(count, (chunk + 1) * size); ++i)
                 {
                     sum = sum + item(i);
                 }
                 sums[chunk] = sum;
             });
}

/// Calls f(r, lanes) for every run r; runs are short.
template<class F>
void for_each_run(const Cpu& cpu, const char* name, const RunsView& runs, F f)
{
    for_each(cpu, name, runs.count, [=](std::int64_t run) { f(run, dem::OneLane{}); });
}

} // namespace tread::contact
