// Instantiates sums_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/dem/motion/sums_impl.hpp"
