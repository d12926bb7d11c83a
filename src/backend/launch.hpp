#pragma once

#include <cstdint>

#include "backend/counters.hpp"
#include "backend/execution.hpp"

namespace tread
{

/// Runs f(i) for i in [0, n) with light items: each thread takes an equal contiguous range.
template<class F>
void for_each(const Cpu& cpu, const char* name, std::int64_t n, F f)
{
    if (n == 0) { return; }
    cpu.counters->launched(name);
    if (cpu.number.is_over()) { return; }
    constexpr std::int64_t worth_threads =
        16384; // about a millisecond of work: a barrier can cost as much on a busy machine
#pragma omp parallel for schedule(static) if (n >= worth_threads)
    for (std::int64_t i = 0; i < n; ++i) { f(i); }
}

/// Runs f(i) for i in [0, n) with heavy, uneven items (a page, a body pair): threads take the next few items when they
/// are free. Parallel only for at least `worth_threads` items.
template<class F>
void for_each_heavy(const Cpu& cpu, const char* name, std::int64_t n, F f, std::int64_t worth_threads = 2)
{
    if (n == 0) { return; }
    cpu.counters->launched(name);
    if (cpu.number.is_over()) { return; }
#pragma omp parallel for schedule(dynamic, 4) if (n >= worth_threads)
    for (std::int64_t i = 0; i < n; ++i) { f(i); }
}

} // namespace tread
