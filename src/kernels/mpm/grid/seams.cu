// Instantiates seams_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/mpm/grid/seams_impl.hpp"
