#pragma once

// Marks an item function that few scenes need: it is called, so that kernels keep the registers that they have without
// it. Otherwise like TREAD_HD.
#if defined(__CUDACC__)
#define TREAD_HD_OUT_OF_LINE __host__ __device__ __noinline__
#else
#define TREAD_HD_OUT_OF_LINE inline __attribute__((noinline))
#endif
