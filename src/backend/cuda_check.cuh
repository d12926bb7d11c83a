#pragma once

#include <string>

#include <cuda_runtime.h>

#include "base/errors.hpp"

namespace tread
{

/// Throws an EnvironmentError that names the call unless `status` is success.
inline void check_cuda(cudaError_t status, const char* what)
{
    if (status != cudaSuccess)
    {
        throw EnvironmentError(std::string("CUDA: ") + cudaGetErrorString(status) + " in " + what);
    }
}

} // namespace tread
