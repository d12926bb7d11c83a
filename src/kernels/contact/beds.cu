// Instantiates beds_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/contact/beds_impl.hpp"
