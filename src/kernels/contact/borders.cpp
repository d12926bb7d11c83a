// Instantiates borders_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/contact/borders_impl.hpp"
