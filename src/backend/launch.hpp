#pragma once

#include <cstdint>

#include "backend/counters.hpp"
#include "backend/execution.hpp"

namespace tread
{

/// Runs f(i) for i in [0, n), light items: threads take equal runs.
template<class F>
void for_each(const Cpu& cpu, const char* name, std::int64_t n, F f)
{
    if (n == 0) { return; }
    cpu.counters->launched(name);
    constexpr std::int64_t worth_threads =
        16384; // about a millisecond of work: a barrier may cost that on a busy machine
#pragma omp parallel for schedule(static) if (n >= worth_threads)
    for (std::int64_t i = 0; i < n; ++i) { f(i); }
}

/// Runs f(i) for i in [0, n), heavy uneven items (a page, a pair of bodies): threads take the next few when free, if
/// there are at least `worth_threads` of them.
template<class F>
void for_each_heavy(const Cpu& cpu, const char* name, std::int64_t n, F f, std::int64_t worth_threads = 2)
{
    if (n == 0) { return; }
    cpu.counters->launched(name);
#pragma omp parallel for schedule(dynamic, 4) if (n >= worth_threads)
    for (std::int64_t i = 0; i < n; ++i) { f(i); }
}

} // namespace tread
