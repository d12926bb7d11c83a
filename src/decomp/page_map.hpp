#pragma once

#include <cstdint>
#include <vector>

#include "backend/array.hpp"
#include "decomp/partition.hpp"
#include "kernels/mpm/pages/leaving.hpp"

namespace tread::decomp
{

/// Owning rank of each page, and whether sand has been in it: identical on all ranks. The host knows all pages, the
/// backend those that sand has been in.
template<class Exec>
class PageMap
{
public:
    explicit PageMap(const Exec& exec);

    /// Replaces all owners. `key`: ascending and unique; one rank for each. Sand has been in no page that is new.
    void assign(std::vector<std::uint64_t> key, PageRanks rank);

    /// Marks pages that sand has entered. `key`: ascending and unique. One that has no owner gets its `rank`.
    void enter_sand(const std::vector<std::uint64_t>& key, const PageRanks& rank);

    /// Likewise of pages that have owners.
    void enter_sand(const std::vector<std::uint64_t>& key) { enter_sand(key, PageRanks(key.size(), -1)); }

    const std::vector<std::uint64_t>& keys() const { return key_; }
    const PageRanks&                  ranks() const { return rank_; }
    const std::vector<std::uint8_t>&  sand() const { return sand_; }

    /// Number of changes so far; data derived from the map is stale once it has changed.
    std::int64_t changes() const { return changes_; }

    /// The owner of a page, or -1.
    std::int32_t owner(std::uint64_t page) const;

    /// View for kernels, of the pages that sand has been in.
    mpm::PageOwnersView view() const;

private:
    void share();

    std::vector<std::uint64_t> key_;
    PageRanks                  rank_;
    std::vector<std::uint8_t>  sand_; ///< of each page: 1 = sand has been in it
    std::int64_t               changes_ = 0;
    Array<Exec, std::uint64_t> device_key_;
    Array<Exec, std::int32_t>  device_rank_;
};

} // namespace tread::decomp
