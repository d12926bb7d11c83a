#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tread::decomp
{

/// Bytes in a row of a buffer that go to a rank, or come from it.
struct MessageRange
{
    int          rank;
    std::int64_t first;
    std::int64_t bytes;
};

using MessageRanges = std::vector<MessageRange>;

} // namespace tread::decomp
