#include "decomp/page_ownership.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::decomp
{
namespace
{

constexpr std::int32_t farthest_owner = 2; ///< pages; farthest page that still determines an owner

void keep_each_once(std::vector<std::int32_t>& ranks)
{
    std::sort(ranks.begin(), ranks.end());
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
}

/// Calls visit for every page with a key up to `reach` away along each axis, including the page itself.
template<class Visit>
void for_each_around(const mpm::Index3& page, std::int32_t reach, const Visit& visit)
{
    const auto end   = [&](std::int32_t along) { return std::min(along + reach, mpm::page_bias - 1); };
    const auto begin = [&](std::int32_t along) { return std::max(along - reach, -mpm::page_bias); };
    for (std::int32_t z = begin(page.z); z <= end(page.z); ++z)
    {
        for (std::int32_t y = begin(page.y); y <= end(page.y); ++y)
        {
            for (std::int32_t x = begin(page.x); x <= end(page.x); ++x) { visit(mpm::Index3{x, y, z}); }
        }
    }
}

std::int64_t squared_distance(const mpm::Index3& a, const mpm::Index3& b)
{
    const std::int64_t x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return x * x + y * y + z * z;
}

/// Low corner (m) of the page's cells.
Vec3<double> low_corner(const PageLattice& lattice, const mpm::Index3& page)
{
    return lattice.spacing *
           (mpm::page_edge * Vec3<double>(page.x, page.y, page.z) + Vec3<double>::Constant(lattice.stencil_shift));
}

double width_of_page(const PageLattice& lattice) { return lattice.spacing * mpm::page_edge; }

/// From a place to the page's cells, m2.
double squared_distance_to(const PageLattice& lattice, const Vec3<double>& place, const mpm::Index3& page)
{
    const Vec3<double> low     = low_corner(lattice, page);
    const Vec3<double> nearest = place.cwiseMax(low).cwiseMin(low + Vec3<double>::Constant(width_of_page(lattice)));
    return (nearest - place).squaredNorm();
}

/// Whether the ball overlaps the page's cells.
bool reaches(const PageLattice& lattice, const Vec3<double>& centre, double radius, const mpm::Index3& page)
{
    return squared_distance_to(lattice, centre, page) <= radius * radius;
}

} // namespace

PageOwnership::PageOwnership(const PageLattice& lattice, const std::vector<std::uint64_t>& key, const PageRanks& rank,
                             const std::vector<std::uint8_t>& sand)
    : lattice_(lattice)
    , key_(key)
    , rank_(rank)
    , sand_(sand)
    , all_(rank)
{
    keep_each_once(all_);
}

std::size_t PageOwnership::last_up_to(std::uint64_t page_key) const
{
    const auto after = std::upper_bound(key_.begin(), key_.end(), page_key);
    return after == key_.begin() ? 0 : static_cast<std::size_t>(after - key_.begin()) - 1;
}

bool PageOwnership::has_sand(std::uint64_t page_key) const
{
    const std::size_t at = last_up_to(page_key);
    return key_[at] == page_key && sand_[at] != 0;
}

std::int32_t PageOwnership::nearest_owner(std::uint64_t page_key) const
{
    const mpm::Index3 page     = mpm::page_coordinates(page_key);
    std::int64_t      shortest = std::numeric_limits<std::int64_t>::max();
    std::size_t       nearest  = last_up_to(page_key);
    for_each_around(page, farthest_owner,
                    [&](const mpm::Index3& at)
                    {
                        const std::uint64_t key   = mpm::page_key(at);
                        const std::size_t   found = last_up_to(key);
                        const std::int64_t  way   = squared_distance(page, at);
                        if (key_[found] != key || way >= shortest) { return; }
                        shortest = way;
                        nearest  = found;
                    });
    return rank_[nearest];
}

std::int32_t PageOwnership::owner_of(std::uint64_t page_key)
{
    const std::size_t at = last_up_to(page_key);
    if (key_[at] == page_key) { return rank_[at]; }
    const auto [unseen, is_new] = unseen_.try_emplace(page_key);
    if (is_new) { unseen->second = nearest_owner(page_key); }
    return unseen->second;
}

std::uint64_t PageOwnership::page_of(const Vec3<double>& place) const
{
    return mpm::page_key(mpm::page_at(lattice_, place));
}

std::int32_t PageOwnership::owner_of(const Vec3<double>& place) { return owner_of(page_of(place)); }

Surroundings PageOwnership::find_surroundings(std::uint64_t page_key, std::int32_t reach)
{
    const mpm::Index3         page = mpm::page_coordinates(page_key);
    Surroundings              found{owner_of(page_key), {}, 0};
    std::vector<std::int32_t> owners;
    for_each_around(page, reach,
                    [&](const mpm::Index3& at)
                    {
                        const std::uint64_t key   = mpm::page_key(at);
                        const std::int32_t  owner = owner_of(key);
                        if (owner == found.owner) { return; }
                        found.others.push_back({at, owner, has_sand(key)});
                        owners.push_back(owner);
                    });
    std::stable_sort(found.others.begin(), found.others.end(),
                     [&](const OwnedPage& a, const OwnedPage& b)
                     { return squared_distance(page, a.page) < squared_distance(page, b.page); });
    keep_each_once(owners);
    found.owners = owners.size();
    return found;
}

const Surroundings& PageOwnership::surroundings(std::uint64_t page_key, std::int32_t reach)
{
    const auto [at, is_new] = surroundings_[static_cast<std::size_t>(reach)].try_emplace(page_key);
    if (is_new) { at->second = find_surroundings(page_key, reach); }
    return at->second;
}

Vicinity PageOwnership::around(const Vec3<double>& place, const mpm::Reach& reach)
{
    const std::int32_t  pages = mpm::pages_reached(lattice_, std::max(reach.bodies, reach.sand));
    const Surroundings* near  = pages > mpm::most_reach ? nullptr : &surroundings(page_of(place), pages);
    return {lattice_, all_, place, reach, near, pages * width_of_page(lattice_)};
}

Vicinity::Vicinity(const PageLattice& lattice, const std::vector<std::int32_t>& all, const Vec3<double>& place,
                   const mpm::Reach& reach, const Surroundings* near, double farthest)
    : lattice_(lattice)
    , all_(all)
    , place_(place)
    , reach_(reach)
    , near_(near)
    , farthest_(farthest)
{
}

bool Vicinity::is_reached(const OwnedPage& other) const
{
    const double radius = other.has_sand ? std::max(reach_.bodies, reach_.sand) : reach_.bodies;
    return reaches(lattice_, place_, radius, other.page);
}

void Vicinity::find_owners(std::vector<std::int32_t>& ranks) const
{
    if (near_ == nullptr)
    {
        ranks = all_;
        return;
    }
    ranks.assign(1, near_->owner);
    for (const OwnedPage& other : near_->others)
    {
        if (ranks.size() > near_->owners) { break; }
        const bool is_known = std::find(ranks.begin(), ranks.end(), other.owner) != ranks.end();
        if (!is_known && is_reached(other)) { ranks.push_back(other.owner); }
    }
    std::sort(ranks.begin(), ranks.end());
}

std::int32_t Vicinity::owner_before_all(std::int32_t rank) const
{
    const bool is_near =
        std::any_of(near_->others.begin(), near_->others.end(),
                    [&](const OwnedPage& other)
                    { return other.owner == rank && reaches(lattice_, place_, reach_.bodies, other.page); });
    return is_near ? rank : near_->owner;
}

mpm::Reach Vicinity::clear_of_others(std::int32_t rank) const
{
    constexpr mpm::Reach unknown{0, 0};
    if (near_ == nullptr || near_->owner != rank) { return unknown; }
    double bodies = farthest_ * farthest_, sand = bodies; // squares
    for (const OwnedPage& other : near_->others)
    {
        const double way = squared_distance_to(lattice_, place_, other.page);
        bodies           = std::min(bodies, way);
        if (other.has_sand) { sand = std::min(sand, way); }
        if (bodies <= reach_.bodies * reach_.bodies || sand <= reach_.sand * reach_.sand) { return unknown; }
    }
    return {std::sqrt(bodies), std::sqrt(sand)};
}

} // namespace tread::decomp
