#pragma once

#include <type_traits>

#include "backend/counters.hpp"
#include "backend/device.hpp"
#include "backend/execution.hpp"

// The backends of this build, for code that is compiled once for each of them. No file outside this room asks whether
// there was a CUDA compiler.
namespace tread
{

/// Name of a backend.
enum class Backend
{
    cpu,
    cuda
};

#ifdef TREAD_WITH_CUDA
/// Whether this build has a GPU backend.
inline constexpr bool has_gpu = true;

/// List<Cpu, Gpu>; without a GPU backend List<Cpu>.
template<template<class...> class List>
using BackendList = List<Cpu, Gpu>;

/// List of Case<Exec, Real> for every backend and precision.
template<template<class...> class List, template<class, class> class Case>
using BackendAndRealList = List<Case<Cpu, float>, Case<Cpu, double>, Case<Gpu, float>, Case<Gpu, double>>;
#else
inline constexpr bool has_gpu = false;

template<template<class...> class List>
using BackendList = List<Cpu>;

template<template<class...> class List, template<class, class> class Case>
using BackendAndRealList = List<Case<Cpu, float>, Case<Cpu, double>>;
#endif

/// Whether an execution tag is that of a GPU: launches return before their work is complete, and the host cannot read
/// the backend's memory.
template<class Exec>
inline constexpr bool is_gpu = std::is_same_v<Exec, Gpu>;

/// Calls f with the execution tag of `backend`; `device` is the number of the GPU. Throws EnvironmentError if this
/// build or this machine has no such backend.
template<class F>
void with_backend(Backend backend, int device, Counters& counters, F f)
{
    if (backend == Backend::cpu)
    {
        f(Cpu{&counters});
        return;
    }
    const Device gpu(device, counters);
    if constexpr (has_gpu) { f(gpu.gpu()); }
}

} // namespace tread
