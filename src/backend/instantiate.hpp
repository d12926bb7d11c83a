#pragma once

#include "backend/execution.hpp"

// Explicit instantiations for the backends of this build, from sources that never see CUDA's headers. MACRO makes one,
// without its semicolon.

#ifdef TREAD_WITH_CUDA
/// MACRO(Exec) for every backend.
#define TREAD_FOR_BACKENDS(MACRO)                                                                                      \
    MACRO(Cpu);                                                                                                        \
    MACRO(Gpu);
/// MACRO(Exec, Real) for every backend and precision.
#define TREAD_FOR_BACKENDS_AND_REALS(MACRO)                                                                            \
    MACRO(Cpu, float);                                                                                                 \
    MACRO(Cpu, double);                                                                                                \
    MACRO(Gpu, float);                                                                                                 \
    MACRO(Gpu, double);
#else
#define TREAD_FOR_BACKENDS(MACRO) MACRO(Cpu);
#define TREAD_FOR_BACKENDS_AND_REALS(MACRO)                                                                            \
    MACRO(Cpu, float);                                                                                                 \
    MACRO(Cpu, double);
#endif

// Explicit instantiations for the backend that the compiler at work makes, from an _impl.hpp whose loops both backends
// share: a .cpp makes those of the CPU, a .cu those of the GPU.

#ifdef __CUDACC__
/// MACRO(Exec) for this backend.
#define TREAD_FOR_THIS_BACKEND(MACRO) MACRO(Gpu);
/// MACRO(Exec, Real) for this backend and every precision.
#define TREAD_FOR_THIS_BACKEND_AND_REALS(MACRO)                                                                        \
    MACRO(Gpu, float);                                                                                                 \
    MACRO(Gpu, double);
#else
#define TREAD_FOR_THIS_BACKEND(MACRO) MACRO(Cpu);
#define TREAD_FOR_THIS_BACKEND_AND_REALS(MACRO)                                                                        \
    MACRO(Cpu, float);                                                                                                 \
    MACRO(Cpu, double);
#endif
