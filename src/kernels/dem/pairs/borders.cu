// Instantiates borders_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/dem/pairs/borders_impl.hpp"
