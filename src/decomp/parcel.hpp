#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tread::decomp
{

/// Bytes in a row of a buffer that go to a rank, or come from it.
struct Parcel
{
    int          rank;
    std::int64_t first;
    std::int64_t bytes;
};

using Parcels = std::vector<Parcel>;

} // namespace tread::decomp
