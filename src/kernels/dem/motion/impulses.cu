// Instantiates impulses_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/dem/motion/impulses_impl.hpp"
