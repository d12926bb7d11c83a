// Instantiates records_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/dem/pairs/records_impl.hpp"
