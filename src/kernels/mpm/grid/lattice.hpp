#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kernels/mpm/pages/page_key.hpp"

namespace tread::mpm
{

/// Positions of the nodes and cells of a grid.
struct Lattice
{
    double spacing;         ///< m
    double inverse_spacing; ///< 1/m
    double
        stencil_shift; ///< from a node to the low end of the cell that it names, in spacings: 0.5 quadratic, 0 linear
    double node_shift; ///< node j is at (j + node_shift) spacing; nonzero only on refined levels (levels.hpp)
};

TREAD_HD Lattice make_lattice(double spacing, double stencil_shift) { return {spacing, 1 / spacing, stencil_shift, 0}; }

/// Distance (in spacings) by which a point may leave its cell before it is listed in the next one, so that small
/// oscillations of a bed at rest on cell boundaries do not change the lists. Quadratic weights, continued beyond the
/// cell, still sum to one and reproduce linear fields exactly; they differ from those of the next cell by half the
/// square of this slack, the rounding of fp32. Linear (hat) functions have a kink at the boundary and get no slack.
constexpr double quadratic_cell_slack = 1.0 / 1024;

/// Returns the number of the cell that a distance from the first stencil, in spacings, lies in. Points that flew far
/// away, and positions that are no number, get a cell outside of every domain to which offsets can be added.
TREAD_HD std::int32_t cell_along_axis(double spacings)
{
    constexpr double farthest = 1 << 29;
    return static_cast<std::int32_t>(std::floor(std::min(farthest, std::max(-farthest, spacings))));
}

/// Returns the node that names the cell of a position: the lowest of its stencil. Multiplies by the inverse spacing,
/// because an fp64 division costs a GPU as much as the rest of the stencil. The fused multiply-add is explicit:
/// otherwise compilers would fuse it in some kernels only, and these would disagree about points on a cell boundary.
TREAD_HD Index3 cell_of(const Vec3<double>& position, const Lattice& lattice)
{
    const double inverse = lattice.inverse_spacing, shift = lattice.stencil_shift + lattice.node_shift;
    return {cell_along_axis(std::fma(position[0], inverse, -shift)),
            cell_along_axis(std::fma(position[1], inverse, -shift)),
            cell_along_axis(std::fma(position[2], inverse, -shift))};
}

/// Whether a point listed in `cell` may remain listed there.
TREAD_HD bool stays_in(Index3 cell, const Vec3<double>& position, const Lattice& lattice)
{
    const double reach     = 0.5 + (lattice.stencil_shift > 0 ? quadratic_cell_slack : 0);
    const double shift     = lattice.stencil_shift + lattice.node_shift;
    const double centre[3] = {cell.x + 0.5 + shift, cell.y + 0.5 + shift, cell.z + 0.5 + shift};
    bool         stays     = true;
    for (int c = 0; c < 3; ++c)
    {
        const double off = std::fma(position[c], lattice.inverse_spacing, -centre[c]);
        stays            = stays && off >= -reach && off < reach;
    }
    return stays;
}

/// Box of cells of one lattice, `high` excluded.
struct CellBox
{
    Index3 low{0, 0, 0};
    Index3 high{0, 0, 0};

    /// Returns the box extended by `by` cells on every side.
    TREAD_HD CellBox grown(std::int32_t by) const
    {
        return {{low.x - by, low.y - by, low.z - by}, {high.x + by, high.y + by, high.z + by}};
    }

    TREAD_HD bool contains(Index3 cell) const
    {
        return cell.x >= low.x && cell.x < high.x && cell.y >= low.y && cell.y < high.y && cell.z >= low.z &&
               cell.z < high.z;
    }
};

/// Returns a box larger than any grid.
TREAD_HD CellBox all_cells()
{
    constexpr std::int32_t far = 1 << 30;
    return {{-far, -far, -far}, {far, far, far}};
}

} // namespace tread::mpm
