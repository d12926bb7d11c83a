#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/mpm/pages/page_key.hpp"

// Pages of positions, for bodies and for ranks: anything may be anywhere, in pages without points, too.
namespace tread::mpm
{

/// Mapping from positions to pages.
struct PageLattice
{
    double spacing;       ///< m, of the grid
    double stencil_shift; ///< in spacings
};

/// A page and the number of pages around it that a query considers; none by default.
struct Surroundings
{
    std::uint64_t page  = no_page;
    std::int32_t  reach = 0;

    TREAD_HD bool operator==(const Surroundings& other) const { return page == other.page && reach == other.reach; }
};

inline constexpr std::int32_t most_reach = 15; ///< pages; largest reach for which a ball's surroundings are looked up

/// Returns the page coordinate of a position along one axis, clamped to [low, high], because a body may be anywhere.
TREAD_HD std::int32_t page_coordinate(double position, double spacing, double shift, double low, double high)
{
    const double page = std::floor((position / spacing - shift) / page_edge);
    if (!(page > low)) { return static_cast<std::int32_t>(low); }
    return static_cast<std::int32_t>(page < high ? page : high);
}

/// Returns the page of a position, clamped to those that have keys.
TREAD_HD Index3 page_at(const PageLattice& lattice, const Vec3<double>& x)
{
    const double limit = page_bias - 1;
    return {page_coordinate(x[0], lattice.spacing, lattice.stencil_shift, -limit, limit),
            page_coordinate(x[1], lattice.spacing, lattice.stencil_shift, -limit, limit),
            page_coordinate(x[2], lattice.spacing, lattice.stencil_shift, -limit, limit)};
}

/// Pages that a ball (m) can reach, wherever its centre lies within its page.
TREAD_HD Surroundings surroundings(const PageLattice& lattice, const Vec3<double>& centre, double radius)
{
    const double pages = std::ceil(radius / (lattice.spacing * page_edge)), most = most_reach + 1;
    return {page_key(page_at(lattice, centre)), static_cast<std::int32_t>(pages < most ? pages : most)};
}

} // namespace tread::mpm
