#pragma once

#include <chrono>

#include "backend/memory.hpp"

namespace tread::bench
{

/// Wall time (s) of f() on a backend, including synchronisation.
template<class Exec, class F>
double timed(const Exec& exec, F f)
{
    synchronize(exec);
    const auto start = std::chrono::steady_clock::now();
    f();
    synchronize(exec);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace tread::bench
