#pragma once

#include <cstdint>
#include <limits>

namespace tread
{

/// Rounds a count or size computed as a double down to an integer, limited to the largest one.
inline std::int64_t saturated(double value)
{
    constexpr auto most = std::numeric_limits<std::int64_t>::max();
    if (!(value < static_cast<double>(most))) { return most; }
    return value < 0 ? 0 : static_cast<std::int64_t>(value);
}

} // namespace tread
