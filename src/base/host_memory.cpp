#include "base/host_memory.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include <fmt/format.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

#include "base/bytes_text.hpp"
#include "base/errors.hpp"
#include "base/saturated.hpp"

namespace tread
{
namespace
{

constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::max();

/// Number after a word in a file of words and numbers; empty if there is none.
std::optional<std::int64_t> number_after(const std::filesystem::path& path, const std::string& name)
{
    std::ifstream file(path);
    std::string   word;
    std::int64_t  value = 0;
    while (file >> word)
    {
        if (word == name && file >> value) { return value; }
    }
    return std::nullopt;
}

/// Number at the beginning of a file; empty if it is "max" or there is no file.
std::optional<std::int64_t> number_in(const std::filesystem::path& path)
{
    std::ifstream file(path);
    std::int64_t  value = 0;
    return file >> value ? std::optional(value) : std::nullopt;
}

std::int64_t machine_memory()
{
    const auto kibibytes = number_after("/proc/meminfo", "MemAvailable:");
    return kibibytes ? 1024 * *kibibytes : unknown;
}

std::int64_t left_in_address_space()
{
    rlimit     limit{};
    const auto pages = number_in("/proc/self/statm");
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || !pages) { return unknown; }
    return std::max<std::int64_t>(0, saturated(static_cast<double>(limit.rlim_cur)) - *pages * sysconf(_SC_PAGESIZE));
}

/// Where one version of control groups has its files.
struct GroupFiles
{
    std::filesystem::path root;
    const char*           limit;
    const char*           usage;
};

/// Smallest remaining memory of a group and its parents; caches that the kernel can drop count as free.
std::int64_t left_in_group(const GroupFiles& files, std::filesystem::path group)
{
    std::int64_t least = unknown;
    for (;; group = group.parent_path())
    {
        const auto place = files.root / group.relative_path();
        const auto limit = number_in(place / files.limit), usage = number_in(place / files.usage);
        if (limit && usage)
        {
            const std::int64_t droppable = number_after(place / "memory.stat", "inactive_file").value_or(0);
            least = std::min(least, std::max<std::int64_t>(0, *limit - std::max<std::int64_t>(0, *usage - droppable)));
        }
        if (!group.has_relative_path()) { return least; }
    }
}

} // namespace

std::int64_t memory_left_in_groups(const std::filesystem::path& root)
{
    const GroupFiles first{root / "sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes"};
    const GroupFiles second{root / "sys/fs/cgroup", "memory.max", "memory.current"};
    // Lines are "number:controllers:/path"; version 2 has no controllers.
    std::ifstream groups(root / "proc/self/cgroup");
    std::int64_t  least = unknown;
    for (std::string line; std::getline(groups, line);)
    {
        const auto begin = line.find(':');
        const auto end   = line.find(':', begin + 1);
        if (end == std::string::npos) { continue; }
        const std::string controllers = line.substr(begin + 1, end - begin - 1), path = line.substr(end + 1);
        if (controllers.empty()) { least = std::min(least, left_in_group(second, path)); }
        if (controllers == "memory") { least = std::min(least, left_in_group(first, path)); }
    }
    return least;
}

std::int64_t available_host_memory()
{
    return std::min({machine_memory(), left_in_address_space(), memory_left_in_groups("/")});
}

void require_host_memory(const HostDemand& demand)
{
    const std::int64_t free = available_host_memory();
    if (demand.bytes <= static_cast<double>(free)) { return; }
    throw EnvironmentError(fmt::format("out of host memory: {} take about {}, {} is free: {}, or a machine with more "
                                       "memory",
                                       demand.what, bytes_text(saturated(demand.bytes)), bytes_text(free),
                                       demand.advice));
}

void return_freed_memory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

} // namespace tread
