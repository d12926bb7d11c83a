// Instantiates borders_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/dem/pairs/borders_impl.hpp"
