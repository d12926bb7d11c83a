// Instantiates beds_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/contact/beds_impl.hpp"
