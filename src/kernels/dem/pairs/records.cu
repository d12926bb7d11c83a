// Instantiates records_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/dem/pairs/records_impl.hpp"
