#include "base/process_age.hpp"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <unistd.h>

namespace tread
{
namespace
{

/// Start time of this process in clock ticks since boot; field 22 of the file (man 5 proc). The second field is the
/// program's name in parentheses, which may hold anything. Negative: unknown.
double start_in_ticks()
{
    constexpr int     fields_between = 19;
    std::ifstream     file("/proc/self/stat");
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    const std::size_t name_end = text.rfind(')');
    if (name_end == std::string::npos) { return -1; }
    std::istringstream fields(text.substr(name_end + 1));
    std::string        passed;
    for (int i = 0; i < fields_between; ++i) { fields >> passed; }
    double ticks = -1;
    return fields >> ticks ? ticks : -1;
}

} // namespace

double process_age()
{
    const double    ticks = start_in_ticks(), ticks_a_second = static_cast<double>(sysconf(_SC_CLK_TCK));
    struct timespec now = {};
    if (ticks < 0 || ticks_a_second <= 0 || clock_gettime(CLOCK_BOOTTIME, &now) != 0) { return 0; }
    const double since_boot = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    return std::max(0.0, since_boot - ticks / ticks_a_second);
}

} // namespace tread
