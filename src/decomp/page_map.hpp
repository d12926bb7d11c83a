#pragma once

#include <cstdint>
#include <vector>

#include "backend/array.hpp"
#include "decomp/partition.hpp"
#include "kernels/mpm/pages/leaving.hpp"

namespace tread::decomp
{

/// Owning rank of each page: identical on all ranks, on the host and in the backend's memory.
template<class Exec>
class PageMap
{
public:
    explicit PageMap(const Exec& exec);

    /// Replaces the whole map. `key`: ascending and unique; one rank for each.
    void assign(std::vector<std::uint64_t> key, PageRanks rank);

    /// Adds pages that had no owner, in any order.
    void add(const std::vector<std::uint64_t>& key, const PageRanks& rank);

    const std::vector<std::uint64_t>& keys() const { return key_; }
    const PageRanks&                  ranks() const { return rank_; }

    /// Number of assignments so far; data derived from the owners is stale once it has changed.
    std::int64_t changes() const { return changes_; }

    /// The owner of a page, or -1.
    std::int32_t owner(std::uint64_t page) const;

    /// Device view for kernels.
    mpm::PageOwnersView view() const;

private:
    std::vector<std::uint64_t> key_;
    PageRanks                  rank_;
    std::int64_t               changes_ = 0;
    Array<Exec, std::uint64_t> device_key_;
    Array<Exec, std::int32_t>  device_rank_;
};

} // namespace tread::decomp
