#include "decomp/territory.hpp"

#include <algorithm>

#include "kernels/contact/candidates_kern.hpp"

namespace tread::decomp
{
namespace
{

constexpr std::int64_t most_pages = 1 << 15; ///< that are looked up for one ball

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

/// Whether the ball reaches the page's cells.
bool reaches(const PageLattice& lattice, const Vec3<double>& centre, double radius, const mpm::Index3& page)
{
    const double       width = lattice.spacing * mpm::page_edge;
    const Vec3<double> low =
        Vec3<double>(page.x, page.y, page.z) * width + Vec3<double>::Constant(lattice.spacing * lattice.stencil_shift);
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

/// Keys rise with each coordinate of a page: all of a box lie between those of its two corners.
std::vector<std::int32_t> Territory::owners_near(const Vec3<double>& centre, double radius) const
{
    const Vec3<double>     reach = Vec3<double>::Constant(radius);
    const contact::PageBox box{page_at(lattice_, centre - reach), page_at(lattice_, centre + reach)};
    const std::size_t      first = run_of(mpm::page_key(box.low)), last = run_of(mpm::page_key(box.high));
    if (first == last) { return {rank_[first]}; }
    if (box.pages() > most_pages) { return all_; }
    std::vector<std::int32_t> ranks;
    for (std::int64_t i = 0; i < box.pages(); ++i)
    {
        const mpm::Index3 page = box.page(i);
        if (!reaches(lattice_, centre, radius, page)) { continue; }
        const std::int32_t owner = owner_of(mpm::page_key(page));
        if (ranks.empty() || ranks.back() != owner) { ranks.push_back(owner); }
    }
    keep_each_once(ranks);
    return ranks;
}

} // namespace tread::decomp
