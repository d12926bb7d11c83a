#pragma once

#include "backend/atomic.hpp"
#include "kernels/contact/history.hpp"

namespace tread::contact
{

/// Mixes all bits of a key into all others, because keys of neighbouring points differ in few bits. Finaliser of
/// splitmix64 (G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014;
/// constants of D. Stafford's variant 13).
TREAD_HD std::uint64_t mixed(std::uint64_t key)
{
    key = (key ^ key >> 30) * 0xbf58476d1ce4e5b9ULL;
    key = (key ^ key >> 27) * 0x94d049bb133111ebULL;
    return key ^ key >> 31;
}

/// Returns the bin at which the search for a key starts; `bins` is a power of two.
TREAD_HD std::int64_t home_bin(std::uint64_t key, std::int64_t bins)
{
    return static_cast<std::int64_t>(mixed(key) & static_cast<std::uint64_t>(bins - 1));
}

TREAD_HD std::int64_t next_bin(std::int64_t bin, std::int64_t bins) { return (bin + 1) & (bins - 1); }

/// Claims the first empty bin from the key's home bin on.
TREAD_HD void claim_bin(const HistoryView& history, std::uint64_t key, std::int32_t record)
{
    std::int64_t bin = home_bin(key, history.bins);
    while (compare_and_swap(history.bin_key + bin, 0, key) != 0) { bin = next_bin(bin, history.bins); }
    history.bin_record[bin] = record;
}

/// Returns the record stored under the key, or zero if there is none.
TREAD_HD Tangential recall(const HistoryView& history, std::uint64_t key)
{
    if (history.bins == 0) { return no_tangential(); }
    std::int64_t bin = home_bin(key, history.bins);
    while (history.bin_key[bin] != 0)
    {
        if (history.bin_key[bin] == key) { return history.tangential[history.bin_record[bin]]; }
        bin = next_bin(bin, history.bins);
    }
    return no_tangential();
}

} // namespace tread::contact
