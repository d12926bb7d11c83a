// Instantiates rows_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "decomp/rows_impl.hpp"
