#include "base/thread_wait.hpp"

#include <cstdlib>
#include <filesystem>

#include <unistd.h>

namespace tread
{

void limit_spinning(char** arguments)
{
    if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) { return; }
    ::setenv("GOMP_SPINCOUNT", "10000", 1);
    // The path of the program, since a process started from /proc/self/exe is called "exe".
    std::error_code failed;
    const auto      program = std::filesystem::read_symlink("/proc/self/exe", failed);
    if (!failed) { ::execv(program.c_str(), arguments); }
}

} // namespace tread
