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

auto PageOwnership::find_others(const mpm::Index3& page, std::int32_t reach, Among among) -> OwnedPages
{
    const std::int32_t own = owner_of(mpm::page_key(page));
    OwnedPages         others;
    for_each_around(page, reach,
                    [&](const mpm::Index3& at)
                    {
                        const std::uint64_t key = mpm::page_key(at);
                        if (among == Among::with_sand && !has_sand(key)) { return; }
                        const std::int32_t owner = owner_of(key);
                        if (owner != own) { others.push_back({at, owner}); }
                    });
    return others;
}

auto PageOwnership::others_near(std::uint64_t page_key, std::int32_t reach, Among among) -> const OwnedPages&
{
    const auto [at, is_new] = others_[{reach, among}].try_emplace(page_key);
    if (is_new) { at->second = find_others(mpm::page_coordinates(page_key), reach, among); }
    return at->second;
}

/// Stops at a page within the radius, since then it does not matter how near.
double PageOwnership::distance_to_others(const Vec3<double>& place, double radius, Among among)
{
    const std::int32_t pages    = mpm::pages_reached(lattice_, radius);
    const double       farthest = pages * width_of_page(lattice_);
    double             nearest  = farthest * farthest;
    for (const OwnedPage& other : others_near(page_of(place), pages, among))
    {
        nearest = std::min(nearest, squared_distance_to(lattice_, place, other.page));
        if (nearest <= radius * radius) { break; }
    }
    return std::sqrt(nearest);
}

mpm::Reach PageOwnership::clear_of_others(std::int32_t rank, const Vec3<double>& place, const mpm::Reach& reach)
{
    constexpr mpm::Reach unknown{0, 0};
    const std::int32_t   pages = mpm::pages_reached(lattice_, std::max(reach.bodies, reach.sand));
    if (pages > mpm::most_reach || owner_of(place) != rank) { return unknown; }
    const double bodies = distance_to_others(place, reach.bodies, Among::all);
    if (bodies <= reach.bodies) { return unknown; }
    const double sand = distance_to_others(place, reach.sand, Among::with_sand);
    return sand <= reach.sand ? unknown : mpm::Reach{bodies, sand};
}

bool PageOwnership::is_near(std::int32_t rank, const Vec3<double>& centre, double radius)
{
    const std::uint64_t page = page_of(centre);
    if (owner_of(page) == rank) { return true; }
    const OwnedPages& others = others_near(page, mpm::pages_reached(lattice_, radius), Among::all);
    return std::any_of(others.begin(), others.end(),
                       [&](const OwnedPage& other)
                       { return other.owner == rank && reaches(lattice_, centre, radius, other.page); });
}

void PageOwnership::find_owners_near(const Vec3<double>& centre, const mpm::Reach& reach,
                                     std::vector<std::int32_t>& ranks)
{
    if (mpm::pages_reached(lattice_, std::max(reach.bodies, reach.sand)) > mpm::most_reach)
    {
        ranks = all_;
        return;
    }
    const std::uint64_t page = page_of(centre);
    ranks.assign(1, owner_of(page));
    const auto add = [&](double radius, Among among)
    {
        for (const OwnedPage& other : others_near(page, mpm::pages_reached(lattice_, radius), among))
        {
            const bool is_known = std::find(ranks.begin(), ranks.end(), other.owner) != ranks.end();
            if (!is_known && reaches(lattice_, centre, radius, other.page)) { ranks.push_back(other.owner); }
        }
    };
    add(reach.bodies, Among::all);
    add(reach.sand, Among::with_sand);
    std::sort(ranks.begin(), ranks.end());
}

} // namespace tread::decomp
