// Instantiates subcycle_marks_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/dem/motion/subcycle_marks_impl.hpp"
