#pragma once

#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "backend/vector.hpp"
#include "decomp/partition.hpp"
#include "kernels/mpm/pages/page_lattice.hpp"

// Owning rank of any position, on pages of a partition and on pages that it does not contain.
namespace tread::decomp
{

using mpm::PageLattice;

/// Owner lookup for any page. A page outside the partition, above the sand or beside it, belongs to the owner of the
/// nearest page of the partition within two pages, or else to that of the page before it by key (the first page's
/// owner, if there is none before). All ranks with the same partition get the same answers.
class PageOwnership
{
public:
    /// `key`: ascending, unique and not empty; one rank for each. `sand`: 1 for a page that sand has been in.
    PageOwnership(const PageLattice& lattice, const std::vector<std::uint64_t>& key, const PageRanks& rank,
                  const std::vector<std::uint8_t>& sand);

    std::uint64_t page_of(const Vec3<double>& place) const;

    /// Caches the answer for a page outside the partition.
    std::int32_t owner_of(std::uint64_t page_key);
    std::int32_t owner_of(const Vec3<double>& place);

    /// Writes the ranks that own a page within reach (m), or one that sand has been in within the reach of sand,
    /// ascending; all ranks if these may be very many pages. The neighbourhood of the centre's page is cached, so that
    /// later balls there cost next to nothing.
    void find_owners_near(const Vec3<double>& centre, const mpm::Reach& reach, std::vector<std::int32_t>& ranks);

    /// Whether the rank owns a page within the ball (m) of few pages.
    bool is_near(std::int32_t rank, const Vec3<double>& centre, double radius);

    /// Where the rank owns all within reach (m): how far the nearest page is that it does not own, and the nearest one
    /// of these that sand has been in. Looks no further than `reach`, to whole pages. 0 for both where another rank is
    /// within reach, or very many pages are. Caches the pages.
    mpm::Reach clear_of_others(std::int32_t rank, const Vec3<double>& place, const mpm::Reach& reach);

private:
    enum class Among
    {
        all,
        with_sand
    };
    struct OwnedPage
    {
        mpm::Index3  page;
        std::int32_t owner;
    };
    using OwnedPages = std::vector<OwnedPage>;

    std::size_t       last_up_to(std::uint64_t page_key) const;
    bool              has_sand(std::uint64_t page_key) const;
    std::int32_t      nearest_owner(std::uint64_t page_key) const;
    OwnedPages        find_others(const mpm::Index3& page, std::int32_t reach, Among among);
    const OwnedPages& others_near(std::uint64_t page_key, std::int32_t reach, Among among);
    double            distance_to_others(const Vec3<double>& place, double radius, Among among);

    PageLattice                lattice_;
    std::vector<std::uint64_t> key_;
    PageRanks                  rank_; ///< of each key
    std::vector<std::uint8_t>  sand_; ///< of each key
    std::vector<std::int32_t>  all_;  ///< ranks that own any page

    std::unordered_map<std::uint64_t, std::int32_t> unseen_; ///< cached owners of pages that are not in key_

    /// Cache, keyed by reach (in pages) and page: pages within that reach with another owner than the page.
    std::map<std::pair<std::int32_t, Among>, std::unordered_map<std::uint64_t, OwnedPages>> others_;
};

} // namespace tread::decomp
