// Instantiates seams_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/mpm/grid/seams_impl.hpp"
