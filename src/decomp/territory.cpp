#include "decomp/territory.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/contact/candidates_kern.hpp"

namespace tread::decomp
{
namespace
{

constexpr std::int32_t most_reach = 15; ///< pages, around which all are looked up for one ball

void keep_each_once(std::vector<std::int32_t>& ranks)
{
    std::sort(ranks.begin(), ranks.end());
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
}

mpm::Index3 page_at(const PageLattice& lattice, const Vec3<double>& x)
{
    const auto along = [&](int c) { return contact::page_coordinate(x[c], lattice.spacing, lattice.stencil_shift); };
    return {along(0), along(1), along(2)};
}

/// m, of the page's cells.
Vec3<double> low_corner(const PageLattice& lattice, const mpm::Index3& page)
{
    return lattice.spacing *
           (mpm::page_edge * Vec3<double>(page.x, page.y, page.z) + Vec3<double>::Constant(lattice.stencil_shift));
}

/// Whether the ball reaches the page's cells.
bool reaches(const PageLattice& lattice, const Vec3<double>& centre, double radius, const mpm::Index3& page)
{
    const double       width   = lattice.spacing * mpm::page_edge;
    const Vec3<double> low     = low_corner(lattice, page);
    const Vec3<double> nearest = centre.cwiseMax(low).cwiseMin(low + Vec3<double>::Constant(width));
    return (nearest - centre).squaredNorm() <= radius * radius;
}

} // namespace

Territory::Territory(const PageLattice& lattice, const std::vector<std::uint64_t>& key, const PageRanks& rank)
    : lattice_(lattice)
    , all_(rank)
{
    for (std::size_t page = 0; page < key.size(); ++page)
    {
        if (page > 0 && rank[page] == rank_.back()) { continue; }
        first_.push_back(key[page]);
        rank_.push_back(rank[page]);
    }
    keep_each_once(all_);
}

std::size_t Territory::run_of(std::uint64_t page_key) const
{
    const auto after = std::upper_bound(first_.begin(), first_.end(), page_key);
    return after == first_.begin() ? 0 : static_cast<std::size_t>(after - first_.begin()) - 1;
}

std::int32_t Territory::owner_of(std::uint64_t page_key) const { return rank_[run_of(page_key)]; }

std::uint64_t Territory::page_of(const Vec3<double>& place) const { return mpm::page_key(page_at(lattice_, place)); }

std::int32_t Territory::owner_of(const Vec3<double>& place) const { return owner_of(page_of(place)); }

auto Territory::find_others(const mpm::Index3& page, std::int32_t reach) const -> OwnedPages
{
    const double           width  = lattice_.spacing * mpm::page_edge;
    const Vec3<double>     centre = low_corner(lattice_, page) + Vec3<double>::Constant(0.5 * width);
    const Vec3<double>     half   = Vec3<double>::Constant(width * reach);
    const contact::PageBox box{page_at(lattice_, centre - half), page_at(lattice_, centre + half)};
    const std::int32_t     own = owner_of(mpm::page_key(page));
    OwnedPages             others;
    // Keys rise with each coordinate of a page: all of a box lie between those of its two corners.
    if (run_of(mpm::page_key(box.low)) == run_of(mpm::page_key(box.high))) { return others; }
    for (std::int64_t i = 0; i < box.pages(); ++i)
    {
        const mpm::Index3  at    = box.page(i);
        const std::int32_t owner = owner_of(mpm::page_key(at));
        if (owner != own) { others.push_back({at, owner}); }
    }
    return others;
}

auto Territory::others_near(std::uint64_t page_key, std::int32_t reach) -> const OwnedPages&
{
    const auto [at, is_new] = others_[reach].try_emplace(page_key);
    if (is_new) { at->second = find_others(mpm::page_coordinates(page_key), reach); }
    return at->second;
}

Surroundings Territory::surroundings(const Vec3<double>& centre, double radius) const
{
    const double pages = std::ceil(radius / (lattice_.spacing * mpm::page_edge));
    return {page_of(centre), static_cast<std::int32_t>(std::min<double>(pages, most_reach + 1))};
}

bool Territory::is_within(const Surroundings& around, std::int32_t rank)
{
    return around.reach <= most_reach && owner_of(around.page) == rank &&
           others_near(around.page, around.reach).empty();
}

std::vector<std::int32_t> Territory::owners_near(const Vec3<double>& centre, double radius)
{
    const Surroundings around = surroundings(centre, radius);
    if (around.reach > most_reach) { return all_; }
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
