#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/mpm/pages/page_key.hpp"

namespace tread::mpm
{

/// Where the nodes and cells of a grid are.
struct Lattice
{
    double spacing;         ///< m
    double inverse_spacing; ///< 1/m
    double
        stencil_shift; ///< from a node to the low end of the cell that it names, in spacings: 0.5 quadratic, 0 linear
    double node_shift; ///< node j stands at (j + node_shift) spacing; 0 but on refined levels (levels.hpp)
};

TREAD_HD Lattice make_lattice(double spacing, double stencil_shift) { return {spacing, 1 / spacing, stencil_shift, 0}; }

/// How far (in spacings) a point may pass the boundary of its cell before it is listed in the next one: beds at rest on
/// a lattice that falls on boundaries do not change their lists with every breath. Quadratic weights, continued beyond
/// the cell, still sum to one and reproduce linear fields exactly; they differ from the next cell's by half the square
/// of this, the rounding of fp32. Hats have a kink at the boundary, and no slack.
constexpr double quadratic_cell_slack = 1.0 / 1024;

/// Node that names the cell of a position: the lowest of its stencil. A product with the inverse, not a quotient: fp64
/// division costs a GPU as much as the rest of the stencil. The multiply-add is explicit: left to compilers it would be
/// fused in one kernel and not in another, and they would disagree about points on the boundary of a cell.
TREAD_HD Index3 cell_of(const Vec3<double>& position, const Lattice& lattice)
{
    const double inverse = lattice.inverse_spacing, shift = lattice.stencil_shift + lattice.node_shift;
    return {static_cast<std::int32_t>(std::floor(std::fma(position[0], inverse, -shift))),
            static_cast<std::int32_t>(std::floor(std::fma(position[1], inverse, -shift))),
            static_cast<std::int32_t>(std::floor(std::fma(position[2], inverse, -shift)))};
}

/// Whether a point of `cell` may stay listed there.
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

/// Cells of one lattice, `high` excluded.
struct CellBox
{
    Index3 low{0, 0, 0};
    Index3 high{0, 0, 0};

    /// The box with so many more cells on every side.
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

/// Larger than any grid.
TREAD_HD CellBox all_cells()
{
    constexpr std::int32_t far = 1 << 30;
    return {{-far, -far, -far}, {far, far, far}};
}

} // namespace tread::mpm
