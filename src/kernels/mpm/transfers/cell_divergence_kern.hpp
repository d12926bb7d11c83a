#pragma once

#include "kernels/mpm/laws/mid_step_kern.hpp"
#include "kernels/mpm/transfers/cell_divergence.hpp"
#include "kernels/mpm/transfers/gather_kern.hpp"

namespace tread::mpm
{

/// Velocities of a page's tile, by tile node.
template<class Real>
using VelocityTile = Real[tile_nodes][3];

template<class Real>
TREAD_HD void load_velocity(const Real* motion, const PagesView& pages, std::int64_t page, int node,
                            VelocityTile<Real>& tile)
{
    const Real* source = tile_source(motion, pages.node_page_of + 8 * page, node);
    for (int c = 0; c < 3; ++c) { tile[node][c] = source[c * page_cells]; }
}

/// Computes the velocity gradient at a stencil from the tile's velocity: [i][j] = d v_i / d x_j, 1/s.
template<class Real>
TREAD_HD Mat3<Real> gradient_at(const Stencil<Real>& s, const VelocityTile<Real>& tile)
{
    Mat3<Real> gradient = Mat3<Real>::Zero();
    const int  base     = tile_base(s.base);
    for (int c = 0; c < 3; ++c)
    {
        for (int b = 0; b < 3; ++b)
        {
            const Real across_x = s.weight[1][b] * s.weight[2][c], y = s.slope[1][b] * s.weight[2][c],
                       z     = s.weight[1][b] * s.slope[2][c];
            Vec3<Real> along = Vec3<Real>::Zero(), row = Vec3<Real>::Zero();
            for (int a = 0; a < 3; ++a)
            {
                const Real*      node = tile[base + tile_offset(a, b, c)];
                const Vec3<Real> v(node[0], node[1], node[2]);
                along += s.slope[0][a] * v;
                row += s.weight[0][a] * v;
            }
            gradient.col(0) += across_x * along;
            gradient.col(1) += y * row;
            gradient.col(2) += z * row;
        }
    }
    return gradient;
}

/// Computes the mean over the points of cell `cell` = 64 * page + place, in the order of the list.
template<class Real>
TREAD_HD Real mean_divergence(const PointsView<Real>& points, const PagesView& pages, std::int64_t cell,
                              const VelocityTile<Real>& tile, Real dt)
{
    const Index3 node =
        node_at(page_coordinates(pages.point_page_key[cell / page_cells]), static_cast<int>(cell % page_cells));
    Real volume = 0, flow = 0;
    for (std::int64_t at = pages.cell_first_point[cell]; at < pages.cell_first_point[cell + 1]; ++at)
    {
        const std::int64_t i        = pages.point_at[at];
        const auto         stencil  = stencil_above<Real>(node, points.position.get(i), pages.inverse_spacing, pages);
        const Mat3<Real>   at_start = gradient_at(stencil, tile);
        const Real         share    = points.volume[i];
        volume += share;
        flow += share * (at_start.trace() + divergence_to_mid_step(at_start, dt));
    }
    return volume > 0 ? flow / volume : Real(0);
}

} // namespace tread::mpm
