#pragma once

#include <cstdint>
#include <string>

// How much host memory this process may still take, and the refusal of what would not fit.
namespace tread
{

/// Bytes that the machine has available, or fewer where a control group or RLIMIT_AS leaves less to this process. The
/// largest integer where nothing is known.
std::int64_t available_host_memory();

/// What is about to be made, for the message that refuses it.
struct HostDemand
{
    double      bytes;
    std::string what;   ///< "[[terrain]] 0: its 1.3e+08 points"
    std::string advice; ///< "a coarser [grid] spacing"
};

/// EnvironmentError, with both figures, where the demand is more than what is available.
void require_host_memory(const HostDemand& demand);

} // namespace tread
