// Instantiates sleeping_contacts_impl.hpp for the GPU.
#include "backend/launch.cuh"
#include "kernels/contact/sleeping_contacts_impl.hpp"
