// Instantiates sums_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/dem/motion/sums_impl.hpp"
