// Instantiates borders_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/contact/borders_impl.hpp"
