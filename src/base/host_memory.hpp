#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

// Host memory still available to this process, and refusal of demands that would not fit.
namespace tread
{

/// Bytes available on the machine, or less if a control group or RLIMIT_AS leaves less to this process. The largest
/// integer if unknown.
std::int64_t available_host_memory();

/// Bytes that control groups (both versions) leave to this process: the least of its groups and their parents, read
/// below `root`, which is "/" on a machine. The largest integer if none limits it.
std::int64_t memory_left_in_groups(const std::filesystem::path& root);

/// A planned allocation, for the message that refuses it.
struct HostDemand
{
    double      bytes;
    std::string what;   ///< "[[terrain]] 0: its 1.3e+08 points"
    std::string advice; ///< "a coarser [grid] spacing"
};

/// EnvironmentError, with both figures, if the demand exceeds the available memory.
void require_host_memory(const HostDemand& demand);

/// Returns memory that was freed to the machine. The C library keeps it otherwise: what set-up took and freed would
/// count with what a run holds.
void return_freed_memory();

} // namespace tread
