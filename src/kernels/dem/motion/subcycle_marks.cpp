// Instantiates subcycle_marks_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/dem/motion/subcycle_marks_impl.hpp"
