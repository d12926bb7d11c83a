// Instantiates displacement_tracker_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/dem/pairs/displacement_tracker_impl.hpp"
