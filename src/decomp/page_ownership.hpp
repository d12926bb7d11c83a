#pragma once

#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

#include "backend/vector.hpp"
#include "decomp/partition.hpp"
#include "kernels/mpm/pages/page_lattice.hpp"

// Owning rank of any position, on pages of a partition and on pages that it does not contain.
namespace tread::decomp
{

using mpm::PageLattice;
using mpm::Surroundings;

/// Owner lookup for any page. A page outside the partition, above the sand or beside it, belongs to the owner of the
/// nearest page of the partition within two pages, or else to that of the page before it by key (the first page's
/// owner, if there is none before). All ranks with the same partition get the same answers.
class PageOwnership
{
public:
    /// `key`: ascending, unique and not empty; one rank for each.
    PageOwnership(const PageLattice& lattice, const std::vector<std::uint64_t>& key, const PageRanks& rank);

    std::uint64_t page_of(const Vec3<double>& place) const;

    /// Caches the answer for a page outside the partition.
    std::int32_t owner_of(std::uint64_t page_key);
    std::int32_t owner_of(const Vec3<double>& place);

    /// Ranks that own a page within the ball (m), ascending; all ranks if the ball reaches very many pages. The
    /// neighbourhood of the ball's page is cached, so that later balls there cost next to nothing.
    std::vector<std::int32_t> owners_near(const Vec3<double>& centre, double radius);

    /// Whether the rank owns all of these pages; false if they are very many. Caches the answer.
    bool is_within(const Surroundings& around, std::int32_t rank);

private:
    struct OwnedPage
    {
        mpm::Index3  page;
        std::int32_t owner;
    };
    using OwnedPages = std::vector<OwnedPage>;

    std::size_t       last_up_to(std::uint64_t page_key) const;
    std::int32_t      nearest_owner(std::uint64_t page_key) const;
    OwnedPages        find_others(const mpm::Index3& page, std::int32_t reach);
    const OwnedPages& others_near(std::uint64_t page_key, std::int32_t reach);

    PageLattice                lattice_;
    std::vector<std::uint64_t> key_;
    PageRanks                  rank_; ///< of each key
    std::vector<std::int32_t>  all_;  ///< ranks that own any page

    std::unordered_map<std::uint64_t, std::int32_t> unseen_; ///< cached owners of pages that are not in key_

    /// Cache, keyed by reach (in pages) and page: pages within that reach with another owner than the page.
    std::map<std::int32_t, std::unordered_map<std::uint64_t, OwnedPages>> others_;
};

} // namespace tread::decomp
