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

/// Whether the ball overlaps the page's cells.
bool reaches(const PageLattice& lattice, const Vec3<double>& centre, double radius, const mpm::Index3& page)
{
    const double       width   = lattice.spacing * mpm::page_edge;
    const Vec3<double> low     = low_corner(lattice, page);
    const Vec3<double> nearest = centre.cwiseMax(low).cwiseMin(low + Vec3<double>::Constant(width));
    return (nearest - centre).squaredNorm() <= radius * radius;
}

} // namespace

PageOwnership::PageOwnership(const PageLattice& lattice, const std::vector<std::uint64_t>& key, const PageRanks& rank)
    : lattice_(lattice)
    , key_(key)
    , rank_(rank)
    , all_(rank)
{
    keep_each_once(all_);
}

std::size_t PageOwnership::last_up_to(std::uint64_t page_key) const
{
    const auto after = std::upper_bound(key_.begin(), key_.end(), page_key);
    return after == key_.begin() ? 0 : static_cast<std::size_t>(after - key_.begin()) - 1;
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

auto PageOwnership::find_others(const mpm::Index3& page, std::int32_t reach) -> OwnedPages
{
    const std::int32_t own = owner_of(mpm::page_key(page));
    OwnedPages         others;
    for_each_around(page, reach,
                    [&](const mpm::Index3& at)
                    {
                        const std::int32_t owner = owner_of(mpm::page_key(at));
                        if (owner != own) { others.push_back({at, owner}); }
                    });
    return others;
}

auto PageOwnership::others_near(std::uint64_t page_key, std::int32_t reach) -> const OwnedPages&
{
    const auto [at, is_new] = others_[reach].try_emplace(page_key);
    if (is_new) { at->second = find_others(mpm::page_coordinates(page_key), reach); }
    return at->second;
}

bool PageOwnership::is_within(const Surroundings& around, std::int32_t rank)
{
    return around.reach <= mpm::most_reach && owner_of(around.page) == rank &&
           others_near(around.page, around.reach).empty();
}

std::vector<std::int32_t> PageOwnership::owners_near(const Vec3<double>& centre, double radius)
{
    const Surroundings around = mpm::surroundings(lattice_, centre, radius);
    if (around.reach > mpm::most_reach) { return all_; }
    std::vector<std::int32_t> ranks{owner_of(around.page)};
    for (const OwnedPage& other : others_near(around.page, around.reach))
    {
        if (other.owner != ranks.back() && reaches(lattice_, centre, radius, other.page))
        {
            ranks.push_back(other.owner);
        }
    }
    keep_each_once(ranks);
    return ranks;
}

} // namespace tread::decomp
