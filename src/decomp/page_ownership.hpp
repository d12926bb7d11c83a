#pragma once

#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

#include "backend/vector.hpp"
#include "decomp/partition.hpp"
#include "kernels/mpm/pages/page_key.hpp"

// Which rank owns which place, for every place there is: the pages of a partition and those that may come to be.
namespace tread::decomp
{

/// How positions fall to pages: those of kernels/mpm/pages/pages.hpp.
struct PageLattice
{
    double spacing;       ///< m, of the grid
    double stencil_shift; ///< in spacings
};

/// A page, and how many pages around it count. As made here, none.
struct Surroundings
{
    std::uint64_t page  = mpm::no_page;
    std::int32_t  reach = 0;

    bool operator==(const Surroundings&) const = default;
};

/// A page that no partition has seen, above the sand or beside it, belongs to the rank of the nearest page up to two
/// away that one has, or else to that of the page before it by key (before all, of the first). The same on every rank,
/// as long as it is made of the same partition.
class PageOwnership
{
public:
    /// `key` ascending, each once, at least one, and the rank of each.
    PageOwnership(const PageLattice& lattice, const std::vector<std::uint64_t>& key, const PageRanks& rank);

    std::uint64_t page_of(const Vec3<double>& place) const;

    /// Remembers what it found for a page that no partition has seen.
    std::int32_t owner_of(std::uint64_t page_key);
    std::int32_t owner_of(const Vec3<double>& place);

    /// The ranks that own a page which the ball (m) reaches, ascending; all, where it reaches very many pages.
    /// Remembers what is around the ball's page: next to nothing for the next ball there.
    std::vector<std::int32_t> owners_near(const Vec3<double>& centre, double radius);

    /// The pages that a ball (m) can reach, wherever in its page the centre is.
    Surroundings surroundings(const Vec3<double>& centre, double radius) const;

    /// Whether all of them are the rank's; false where they are very many. Remembers what it found.
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
    std::vector<std::int32_t>  all_;  ///< ranks that own something

    std::unordered_map<std::uint64_t, std::int32_t> unseen_; ///< owners of pages that are not in key_, as asked for

    /// By reach, in pages, and page: pages up to that far from it that are not its owner's.
    std::map<std::int32_t, std::unordered_map<std::uint64_t, OwnedPages>> others_;
};

} // namespace tread::decomp
