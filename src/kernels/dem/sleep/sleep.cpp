// Instantiates sleep_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/dem/sleep/sleep_impl.hpp"
