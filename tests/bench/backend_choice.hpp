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

/// Calls run(execution tag); `device`: that of this process.
template<class Run>
void on_backend(Backend backend, Run run, int device_number = 0)
{
    Counters counters;
    if (backend == Backend::cpu)
    {
        run(Cpu{&counters});
        return;
    }
#ifdef TREAD_WITH_CUDA
    const Device device(device_number, counters);
    run(device.gpu());
#else
    static_cast<void>(device_number);
    throw EnvironmentError("--backend cuda: this build has no GPU backend");
#endif
}

} // namespace tread::bench
