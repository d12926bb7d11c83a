// Instantiates sleeping_contacts_impl.hpp for the CPU.
#include "backend/launch.hpp"
#include "kernels/contact/sleeping_contacts_impl.hpp"
