// Instantiates sleep_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/dem/sleep/sleep_impl.hpp"
