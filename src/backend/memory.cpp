#include "backend/memory.hpp"

#include <cstdlib>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "backend/counters.hpp"
#include "base/bytes_text.hpp"
#include "base/host_memory.hpp"

namespace tread
{

EnvironmentError out_of_memory(const char* memory, const char* name, std::size_t bytes, std::int64_t free,
                               const Counters& counters)
{
    const std::string in_all = counters.expected_bytes() > 0 ? fmt::format(", and is estimated to want {} in all",
                                                                           bytes_text(counters.expected_bytes()))
                                                             : "";
    return EnvironmentError(
        fmt::format("out of {} memory: '{}' wants {}, {} is free; the run holds {}{}: fewer points, a "
                    "coarser grid, or a machine with more memory",
                    memory, name, bytes_text(static_cast<std::int64_t>(bytes)), bytes_text(free),
                    bytes_text(counters.current_bytes()), in_all));
}

std::int64_t free_bytes(const Cpu&) { return available_host_memory(); }

void* allocate(const Cpu& cpu, const char* name, std::size_t bytes)
{
    constexpr std::size_t alignment = 64;
    const std::size_t     rounded   = (bytes + alignment - 1) / alignment * alignment;
    const bool            allowed   = cpu.counters->has_room(static_cast<std::int64_t>(bytes));
    void*                 memory    = allowed ? std::aligned_alloc(alignment, rounded) : nullptr;
    if (memory == nullptr && bytes > 0) { throw out_of_memory("host", name, bytes, free_bytes(cpu), *cpu.counters); }
    return memory;
}

void release(const Cpu&, void* memory) { std::free(memory); }

void fill_zero(const Cpu&, void* memory, std::size_t bytes)
{
    if (bytes > 0) { std::memset(memory, 0, bytes); }
}

void copy(const Cpu&, void* to, const void* from, std::size_t bytes)
{
    if (bytes > 0) { std::memmove(to, from, bytes); }
}

void copy_to_host(const Cpu& cpu, void* to, const void* from, std::size_t bytes) { copy(cpu, to, from, bytes); }

void start_copy_to_host(const Cpu& cpu, void* to, const void* from, std::size_t bytes) { copy(cpu, to, from, bytes); }

void copy_from_host(const Cpu& cpu, void* to, const void* from, std::size_t bytes) { copy(cpu, to, from, bytes); }

void synchronize(const Cpu&) {}

} // namespace tread
