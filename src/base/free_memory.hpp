#pragma once

#include <cstdint>

namespace tread
{

/// Bytes of the machine's memory that this and all other processes leave; the largest number where nothing is known.
std::int64_t free_memory();

} // namespace tread
