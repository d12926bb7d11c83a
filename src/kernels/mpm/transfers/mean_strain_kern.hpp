#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/mpm/transfers/mean_strain.hpp"

namespace tread::mpm
{

template<class Real>
TREAD_HD bool is_nonlocal(const MaterialParameters<Real>& material)
{
    return material.law == LawKind::bolton && material.bolton.nonlocal_weight > 0;
}

/// Returns the cell at a distance of at most 4 cells along each axis from `cell` = 64 * page + place; -1 on a page that
/// is not listed.
TREAD_HD std::int64_t cell_beside(const PagesView& pages, std::int64_t cell, int x, int y, int z)
{
    const std::int64_t page  = cell / page_cells;
    const int          place = static_cast<int>(cell % page_cells);
    const int          i = (place & 3) + x, j = (place >> 2 & 3) + y, k = (place >> 4) + z;
    const int          direction = own_page + (i >> 2) + 3 * (j >> 2) + 9 * (k >> 2);
    const std::int64_t reached   = direction == own_page ? page : pages.neighbour[page * directions + direction];
    return reached < 0 ? -1 : reached * page_cells + ((i & 3) | (j & 3) << 2 | (k & 3) << 4);
}

/// Values of all cells.
template<class Real>
struct CellStrains
{
    Real* mass;   ///< kg
    Real* strain; ///< undefined where the mass is 0

    /// Whether a cell holds points that count.
    TREAD_HD bool holds(std::int64_t cell) const { return cell >= 0 && mass[cell] > 0; }
};

/// Takes the mean over the points of a cell, in the order of the list. Differences from the first point are averaged,
/// so that rounding does not change a constant.
template<class Real>
struct TakeCellStrain
{
    PointsView<Real>                points;
    PagesView                       pages;
    const MaterialParameters<Real>* materials;
    CellStrains<Real>               cells;

    TREAD_HD void operator()(std::int64_t cell) const
    {
        Real mass = 0, first = 0, sum = 0;
        for (std::int64_t at = pages.cell_first_point[cell]; at < pages.cell_first_point[cell + 1]; ++at)
        {
            const std::int64_t i = pages.point_at[at];
            if (!is_nonlocal(materials[points.material[i]])) { continue; }
            const Real strain = std::log(points.volume_ratio[i]) - points.volume_gap[i];
            if (mass == 0) { first = strain; }
            mass += points.mass[i];
            sum += points.mass[i] * (strain - first);
        }
        cells.mass[cell] = mass;
        if (mass > 0) { cells.strain[cell] = first + sum / mass; }
    }
};

/// One pass of smoothing.
template<class Real>
struct SmoothCellStrain
{
    PagesView         pages;
    CellStrains<Real> cells;
    Real              share;
    Real*             smoothed;

    TREAD_HD void operator()(std::int64_t cell) const
    {
        const Real mass = cells.mass[cell];
        if (mass == 0) { return; }
        const Real own = cells.strain[cell];
        Real       sum = 0;
        for (int side = -1; side <= 1; side += 2)
        {
            sum += exchange(own, mass, cell_beside(pages, cell, side, 0, 0));
            sum += exchange(own, mass, cell_beside(pages, cell, 0, side, 0));
            sum += exchange(own, mass, cell_beside(pages, cell, 0, 0, side));
        }
        smoothed[cell] = own + share * sum / mass;
    }

    TREAD_HD Real exchange(Real own, Real mass, std::int64_t other) const
    {
        return cells.holds(other) ? std::min(mass, cells.mass[other]) * (cells.strain[other] - own) : Real(0);
    }
};

/// Interpolates for the points of a cell between the eight nearest cell centres, weighted by mass.
template<class Real>
struct GiveMeanStrain
{
    PointsView<Real>                points;
    PagesView                       pages;
    const MaterialParameters<Real>* materials;
    CellStrains<Real>               cells;

    TREAD_HD void operator()(std::int64_t cell) const
    {
        if (cells.mass[cell] == 0) { return; }
        const Index3 node =
            node_at(page_coordinates(pages.point_page_key[cell / page_cells]), static_cast<int>(cell % page_cells));
        for (std::int64_t at = pages.cell_first_point[cell]; at < pages.cell_first_point[cell + 1]; ++at)
        {
            const std::int64_t i = pages.point_at[at];
            if (!is_nonlocal(materials[points.material[i]])) { continue; }
            points.mean_strain[i] = interpolate(cell, node, points.position.get(i));
        }
    }

    TREAD_HD Real interpolate(std::int64_t cell, Index3 node, const Vec3<double>& position) const
    {
        const double centre = 0.5 + pages.stencil_shift + pages.node_shift;
        const double low[3] = {node.x + centre, node.y + centre, node.z + centre};
        int          side[3];
        Real         away[3]; // of the point from its cell's centre, in cells
        for (int c = 0; c < 3; ++c)
        {
            const Real off = static_cast<Real>(position[c] * pages.inverse_spacing - low[c]);
            side[c]        = off < 0 ? -1 : 1;
            away[c]        = std::fabs(off);
        }
        const Real own    = cells.strain[cell];
        Real       weight = 0, sum = 0;
        for (int corner = 0; corner < 8; ++corner)
        {
            const int          x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
            const std::int64_t other = cell_beside(pages, cell, x * side[0], y * side[1], z * side[2]);
            if (!cells.holds(other)) { continue; }
            const Real share = cells.mass[other] * (x != 0 ? away[0] : 1 - away[0]) * (y != 0 ? away[1] : 1 - away[1]) *
                               (z != 0 ? away[2] : 1 - away[2]);
            weight += share;
            sum += share * (cells.strain[other] - own);
        }
        return own + sum / weight;
    }
};

} // namespace tread::mpm
