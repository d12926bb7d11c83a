#include "base/thread_wait.hpp"

#include <cstdlib>

#include <unistd.h>

namespace tread
{

void limit_spinning(char** arguments)
{
    if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) { return; }
    ::setenv("GOMP_SPINCOUNT", "10000", 1); // some 10 us, less than it takes to wake a thread
    ::execv("/proc/self/exe", arguments);
}

} // namespace tread
