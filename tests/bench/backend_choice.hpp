#pragma once

#include "backend/counters.hpp"
#include "backend/execution.hpp"
#include "base/errors.hpp"
#ifdef TREAD_WITH_CUDA
#include "backend/device.hpp"
#endif

namespace tread::bench
{

enum class Backend
{
    cpu,
    cuda
};

/// Calls run(execution tag).
template<class Run>
void on_backend(Backend backend, Run run)
{
    Counters counters;
    if (backend == Backend::cpu)
    {
        run(Cpu{&counters});
        return;
    }
#ifdef TREAD_WITH_CUDA
    const Device device(0, counters);
    run(device.gpu());
#else
    throw EnvironmentError("--backend cuda: this build has no GPU backend");
#endif
}

} // namespace tread::bench
