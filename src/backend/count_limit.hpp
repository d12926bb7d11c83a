#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "base/errors.hpp"

namespace tread
{

/// Throws if a list has too many entries: lists (body pairs, their nodes, points of cells) are indexed by int32.
inline void require_countable(std::int64_t entries)
{
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    if (entries <= most) { return; }
    throw NumericalError("a list of contacts or cells would have " + std::to_string(entries) + " entries (at most " +
                         std::to_string(most) + "): fewer bodies or points, or a smaller dt if they are fast");
}

} // namespace tread
