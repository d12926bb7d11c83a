#pragma once

#include <cstdint>
#include <limits>

namespace tread
{

/// A count or a size that was computed as a double: the integer below it, or the largest where it is beyond that.
inline std::int64_t saturated(double value)
{
    constexpr auto most = std::numeric_limits<std::int64_t>::max();
    if (!(value < static_cast<double>(most))) { return most; }
    return value < 0 ? 0 : static_cast<std::int64_t>(value);
}

} // namespace tread
