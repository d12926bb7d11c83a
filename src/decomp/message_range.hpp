#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tread::decomp
{

/// Contiguous bytes of a buffer that are sent to a rank, or received from it.
struct MessageRange
{
    int          rank;
    std::int64_t first;
    std::int64_t bytes;
};

using MessageRanges = std::vector<MessageRange>;

} // namespace tread::decomp
