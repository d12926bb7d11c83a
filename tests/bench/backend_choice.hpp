#pragma once

#include "backend/backends.hpp"

namespace tread::bench
{

/// Calls run(execution tag); `device`: that of this process.
template<class Run>
void on_backend(Backend backend, Run run, int device = 0)
{
    Counters counters;
    with_backend(backend, device, counters, run);
}

} // namespace tread::bench
