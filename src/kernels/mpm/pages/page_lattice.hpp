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

/// Balls around one centre, m: other bodies within the first matter, and sand within the second.
struct Reach
{
    double bodies;
    double sand;
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

/// Number of pages that a ball (m) reaches in any direction, wherever its centre lies within its page.
TREAD_HD std::int32_t pages_reached(const PageLattice& lattice, double radius)
{
    const double pages = std::ceil(radius / (lattice.spacing * page_edge)), most = most_reach + 1;
    return static_cast<std::int32_t>(pages < most ? pages : most);
}

} // namespace tread::mpm
