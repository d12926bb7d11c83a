#include "backend/memory.hpp"

#include <cstdlib>
#include <cstring>
#include <string>

#include "base/errors.hpp"

namespace tread
{

void* allocate(const Cpu&, std::size_t bytes)
{
    constexpr std::size_t alignment = 64;
    void*                 memory    = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (memory == nullptr && bytes > 0)
    {
        throw EnvironmentError("out of host memory: " + std::to_string(bytes) + " bytes wanted at once");
    }
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

void copy_from_host(const Cpu& cpu, void* to, const void* from, std::size_t bytes) { copy(cpu, to, from, bytes); }

void synchronize(const Cpu&) {}

} // namespace tread
