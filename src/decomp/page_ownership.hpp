#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "backend/vector.hpp"
#include "decomp/partition.hpp"
#include "kernels/mpm/pages/page_lattice.hpp"

// Owning rank of any position, on pages of a partition and on pages that it does not contain.
namespace tread::decomp
{

using mpm::PageLattice;

/// A page, who owns it, and whether sand has been in it.
struct OwnedPage
{
    mpm::Index3  page;
    std::int32_t owner;
    bool         has_sand;
};

/// A page's owner, and the pages around it that others own, the nearest first, so that most looks end soon.
struct Surroundings
{
    std::int32_t           owner;
    std::vector<OwnedPage> others;
    std::size_t            owners; ///< number of those of `others`
};

/// Owners around a place, out to a reach (m) for bodies and for sand. Valid while the PageOwnership that it is from is.
class Vicinity
{
public:
    /// `all`: ranks that own any page; `near`: of the place's page, null if very many pages are within reach;
    /// `farthest`: m, how far pages were looked at.
    Vicinity(const PageLattice& lattice, const std::vector<std::int32_t>& all, const Vec3<double>& place,
             const mpm::Reach& reach, const Surroundings* near, double farthest);

    /// Writes the ranks that own a page within reach, or one that sand has been in within the reach of sand, ascending;
    /// all ranks if these may be very many pages.
    void find_owners(std::vector<std::int32_t>& ranks) const;

    /// The rank if it owns a page within the reach of bodies, else the owner of the place's page. Of few pages.
    std::int32_t owner_before_all(std::int32_t rank) const;

    /// Where the rank owns all within reach: how far the nearest page is that it does not own, and the nearest one of
    /// these that sand has been in. Looks no further than the larger reach, to whole pages. 0 for both where another
    /// rank is within reach, or very many pages are.
    mpm::Reach clear_of_others(std::int32_t rank) const;

private:
    bool is_reached(const OwnedPage& other) const;

    const PageLattice&               lattice_;
    const std::vector<std::int32_t>& all_;
    Vec3<double>                     place_;
    mpm::Reach                       reach_;
    const Surroundings*              near_;
    double                           farthest_;
};

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

    /// Owners around a place. What surrounds its page is cached, so that later places there cost a lookup.
    Vicinity around(const Vec3<double>& place, const mpm::Reach& reach);

private:
    std::size_t         last_up_to(std::uint64_t page_key) const;
    bool                has_sand(std::uint64_t page_key) const;
    std::int32_t        nearest_owner(std::uint64_t page_key) const;
    Surroundings        find_surroundings(std::uint64_t page_key, std::int32_t reach);
    const Surroundings& surroundings(std::uint64_t page_key, std::int32_t reach);

    PageLattice                lattice_;
    std::vector<std::uint64_t> key_;
    PageRanks                  rank_; ///< of each key
    std::vector<std::uint8_t>  sand_; ///< of each key
    std::vector<std::int32_t>  all_;  ///< ranks that own any page

    std::unordered_map<std::uint64_t, std::int32_t> unseen_; ///< cached owners of pages that are not in key_

    /// Cache, by reach (in pages) and page.
    std::array<std::unordered_map<std::uint64_t, Surroundings>, mpm::most_reach + 1> surroundings_;
};

} // namespace tread::decomp
