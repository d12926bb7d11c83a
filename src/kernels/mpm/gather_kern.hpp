#pragma once

#include "kernels/mpm/gather.hpp"
#include "kernels/mpm/law_kern.hpp"
#include "kernels/mpm/stencil_kern.hpp"

namespace tread::mpm
{

/// Of a node page's motion, the value of tile node `node` of a point page whose eight node pages are `neighbours`.
template<class Real>
TREAD_HD const Real* tile_source(const Real* motion, const std::int32_t* neighbours, int node)
{
    const int x = node % tile_edge, y = node / tile_edge % tile_edge, z = node / (tile_edge * tile_edge);
    const int octant = (x >> 2) | (y >> 2) << 1 | (z >> 2) << 2;
    return motion + std::int64_t(neighbours[octant]) * motion_channels * page_cells +
           ((x & 3) | (y & 3) << 2 | (z & 3) << 4);
}

/// What a point sees of the grid.
template<class Real>
struct Seen
{
    Vec3<Real> velocity; ///< m/s, after the step
    Vec3<Real> change;   ///< m/s, in the step
    Mat3<Real> gradient; ///< 1/s, [i][j] = d v_i / d x_j
    Mat3<Real> moment;   ///< m2/s, sum of weight v (x_node - x_point)^T; APIC only
};

/// tile(node) gives a pointer to the lanes of a tile node: velocity (3), change (3), two pads.
template<class Real, class Tile>
TREAD_HD Seen<Real> see(const Stencil<Real>& s, Real spacing, Tile tile)
{
    Real      sum[lanes] = {}, slope[3][lanes] = {}, moment[3][lanes] = {};
    const int base = tile_base(s.base);
    for (int c = 0; c < 3; ++c)
    {
        for (int b = 0; b < 3; ++b)
        {
            const Real plane = s.weight[1][b] * s.weight[2][c];
            const Real py = s.slope[1][b] * s.weight[2][c], pz = s.weight[1][b] * s.slope[2][c];
            const Real oy = (Real(b) - s.fraction[1]) * spacing, oz = (Real(c) - s.fraction[2]) * spacing;
            for (int a = 0; a < 3; ++a)
            {
                const Real  weight = s.weight[0][a] * plane;
                const Real  dx = s.slope[0][a] * plane, dy = s.weight[0][a] * py, dz = s.weight[0][a] * pz;
                const Real  ox   = (Real(a) - s.fraction[0]) * spacing;
                const auto& node = tile(base + tile_offset(a, b, c));
                for (int l = 0; l < lanes; ++l)
                {
                    const Real value = node[l];
                    const Real share = weight * value;
                    sum[l] += share;
                    slope[0][l] += dx * value;
                    slope[1][l] += dy * value;
                    slope[2][l] += dz * value;
                    moment[0][l] += ox * share;
                    moment[1][l] += oy * share;
                    moment[2][l] += oz * share;
                }
            }
        }
    }
    Seen<Real> seen;
    for (int i = 0; i < 3; ++i)
    {
        seen.velocity[i] = sum[i];
        seen.change[i]   = sum[3 + i];
        for (int j = 0; j < 3; ++j)
        {
            seen.gradient(i, j) = slope[j][i];
            seen.moment(i, j)   = moment[j][i];
        }
    }
    return seen;
}

/// APIC's affine velocity: 4/h^2 times the moment for quadratic splines (Jiang et al. 2015), the velocity gradient for
/// linear ones.
template<class Real>
TREAD_HD void set_affine(const PointsView<Real>& points, std::int64_t i, const Seen<Real>& seen, double spacing,
                         double stencil_shift)
{
    const Real scale = static_cast<Real>(4 / (spacing * spacing));
    for (int a = 0; a < 3; ++a)
    {
        for (int b = 0; b < 3; ++b)
        {
            points.affine.data[(3 * a + b) * points.affine.stride + i] =
                stencil_shift > 0 ? scale * seen.moment(a, b) : seen.gradient(a, b);
        }
    }
}

/// Velocity after the step: FLIP with a share of the grid's. The share is the same for all materials: of points that
/// share nodes, sum m (v_grid - v_flip) = 0 holds for all together, not for each, so that rates by material would not
/// conserve momentum.
template<class Real>
TREAD_HD Vec3<Real> transferred_velocity(const PointsView<Real>& points, std::int64_t i, const Seen<Real>& seen,
                                         Real pic)
{
    return (Real(1) - pic) * (points.velocity.get(i) + seen.change) + pic * seen.velocity;
}

template<class Real, class Sum>
TREAD_HD void keep_for_contact(const PointsView<Real>& points, std::int64_t i, const Seen<Real>& seen, Real dt,
                               Sum* sums)
{
    const Vec3<Real> force = points.contact_force.get(i);
    points.grid_velocity.set(i, seen.velocity);
    points.support.set(i, seen.change / dt - force / points.mass[i]);
    sums[point_contact_power] += Sum(force.dot(seen.velocity - seen.change));
    sums[point_contact_work] += Sum(dt) * Sum(force.dot(seen.velocity - Real(0.5) * seen.change));
}

/// Power of `stress` (Pa) on the symmetric part of `gradient` (1/s), W/m3.
template<class Real>
TREAD_HD Real stress_power(const Sym3<Real>& stress, const Mat3<Real>& gradient)
{
    return stress[0] * gradient(0, 0) + stress[1] * gradient(1, 1) + stress[2] * gradient(2, 2) +
           stress[3] * (gradient(1, 2) + gradient(2, 1)) + stress[4] * (gradient(0, 2) + gradient(2, 0)) +
           stress[5] * (gradient(0, 1) + gradient(1, 0));
}

/// Gives the new stress.
template<class Real, class Sum>
TREAD_HD Sym3<Real> update_material(const PointsView<Real>& points, std::int64_t i, const Mat3<Real>& gradient,
                                    const GatherStep<Real>& step, Sum* sums)
{
    const MaterialParameters<Real>& material = step.materials[points.material[i]];
    const Real                      ratio    = points.volume_ratio[i] * (Real(1) + step.dt * gradient.trace());
    points.volume_ratio[i]                   = ratio;
    PlasticState<Real> state{};
    if (points.plastic_shear != nullptr) { state = {points.plastic_shear[i], Real(0), points.volume_gap[i]}; }
    const StressUpdate<Real> update = update_stress(material, points.stress.get(i), state, gradient, step.dt);
    points.stress.set(i, update.stress);
    sums[point_stress_power] += Sum(points.volume[i] * stress_power(update.stress, gradient));
    sums[point_strain] += Sum(points.volume[i] * elastic_energy_density(material, update.stress));
    if (points.plastic_shear != nullptr)
    {
        points.plastic_shear[i] = update.state.plastic_shear;
        points.plastic_rate[i]  = update.state.plastic_rate;
        points.volume_gap[i]    = update.state.volume_gap;
        const Real work         = update.plastic_work + update.work_to_mean;
        if (work != 0) { sums[point_plastic_work] += Sum(work * points.volume[i]); }
    }
    return update.stress;
}

/// The velocity gradient that the law sees: with cell means, its trace is that of the cell.
template<class Real>
TREAD_HD Mat3<Real> law_gradient(const Mat3<Real>& gradient, const Real* cell_divergence, std::int64_t cell)
{
    if (cell_divergence == nullptr) { return gradient; }
    return gradient + (cell_divergence[cell] - gradient.trace()) * Real(1.0 / 3) * Mat3<Real>::Identity();
}

/// The whole G2P of one point of a page, up to where it is then.
template<class Real, class Sum>
TREAD_HD Move update_point(const PointsView<Real>& points, std::int64_t i, const Seen<Real>& seen, Index3 cell,
                           const PagesView& pages, std::int64_t page, const GatherStep<Real>& step, Sum* sums,
                           Sum* peaks)
{
    const Vec3<Real> velocity = transferred_velocity(points, i, seen, step.pic);
    points.velocity.set(i, velocity);
    if (points.affine.data != nullptr) { set_affine(points, i, seen, pages.spacing, pages.stencil_shift); }
    if (points.contact_force.data != nullptr) { keep_for_contact(points, i, seen, step.dt, sums); }
    const std::int64_t place = page * page_cells + place_in_page(cell);
    const Sym3<Real>   stress =
        update_material(points, i, law_gradient(seen.gradient, step.cell_divergence, place), step, sums);

    const Vec3<double> position = points.position.get(i) + double(step.dt) * seen.velocity.template cast<double>();
    points.position.set(i, position);

    const Real speed_squared = velocity.squaredNorm(), checked = speed_squared + stress.sum();
    sums[point_kinetic] += Sum(Real(0.5) * points.mass[i] * speed_squared);
    const bool finite = std::isfinite(checked);
    const Move move =
        finite ? move_to(pages, page, cell, position) : Move{own_page, place_in_page(cell), Stir::not_finite};
    peaks[peak_speed_squared] = std::fmax(peaks[peak_speed_squared], finite ? Sum(speed_squared) : Sum(0));
    peaks[peak_stir]          = std::fmax(peaks[peak_stir], static_cast<Sum>(move.stir));
    return move;
}

} // namespace tread::mpm
