// Instantiates rows_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "decomp/rows_impl.hpp"
