// Instantiates displacement_tracker_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/dem/pairs/displacement_tracker_impl.hpp"
