#include "base/free_memory.hpp"

#include <fstream>
#include <limits>
#include <string>

namespace tread
{

std::int64_t free_memory()
{
    std::ifstream facts("/proc/meminfo");
    std::string   word;
    std::int64_t  kibibytes = 0;
    while (facts >> word)
    {
        if (word == "MemAvailable:" && facts >> kibibytes) { return 1024 * kibibytes; }
    }
    return std::numeric_limits<std::int64_t>::max(); // not Linux, or no /proc
}

} // namespace tread
