// Instantiates impulses_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/dem/motion/impulses_impl.hpp"
