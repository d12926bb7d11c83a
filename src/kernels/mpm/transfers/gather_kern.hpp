#pragma once

#include <cmath>
#include <type_traits>

#include "kernels/mpm/laws/law_kern.hpp"
#include "kernels/mpm/laws/mid_step_kern.hpp"
#include "kernels/mpm/transfers/gather.hpp"
#include "kernels/mpm/transfers/stencil_kern.hpp"

namespace tread::mpm
{

/// Returns the motion of tile node `node` of a point page whose eight node pages are `neighbours`.
template<class Real>
TREAD_HD const Real* tile_source(const Real* motion, const std::int32_t* neighbours, int node)
{
    const int x = node % tile_edge, y = node / tile_edge % tile_edge, z = node / (tile_edge * tile_edge);
    const int octant = (x >> 2) | (y >> 2) << 1 | (z >> 2) << 2;
    return motion + std::int64_t(neighbours[octant]) * motion_channels * page_cells +
           ((x & 3) | (y & 3) << 2 | (z & 3) << 4);
}

/// State of a point that its update reads.
template<class Real>
struct PointState
{
    Vec3<double> position;
    Vec3<Real>   velocity;
    Sym3<Real>   stress;
    Real         mass, volume, volume_ratio;
    Real         plastic_shear, volume_gap; ///< 0 if no material is plastic
    std::uint8_t material;
};

template<class Real>
TREAD_HD PointState<Real> read_point(const PointsView<Real>& points, std::int64_t i)
{
    const bool plastic = points.plastic_shear != nullptr;
    return {points.position.get(i),
            points.velocity.get(i),
            points.stress.get(i),
            points.mass[i],
            points.volume[i],
            points.volume_ratio[i],
            plastic ? points.plastic_shear[i] : Real(0),
            plastic ? points.volume_gap[i] : Real(0),
            points.material[i]};
}

/// Grid motion interpolated at a point.
template<class Real>
struct Seen
{
    Vec3<Real> velocity; ///< m/s, after the step
    Vec3<Real> change;   ///< m/s, in the step
    Mat3<Real> gradient; ///< 1/s, [i][j] = d v_i / d x_j
    Mat3<Real> moment;   ///< m2/s, sum of weight v (x_node - x_point)^T; affine transfers (APIC, AFLIP) only
};

/// A node's velocity after the step and its change in the step, m/s. `Numbers`: three components, with padding to a
/// vector register, accessed by [].
template<class Numbers>
struct NodeMotion
{
    Numbers velocity, change;
};

/// Partial sums of the motion over rows and layers of nodes, and of the velocity times slopes and node numbers 0..2.
template<class Numbers>
struct Partial
{
    Numbers velocity, by_x, by_y, by_z, change;
    Numbers at_x, at_y, at_z;
};

/// Tag: no moment is computed, because the transfer is not affine (APIC, AFLIP).
struct WithoutMoment
{
};
struct WithMoment
{
};

/// Sums the motion that node(a, b, c) returns for each node of a stencil, axis by axis: a third of the operations of a
/// sum over nodes.
template<class Real, class Node, class Moment>
TREAD_HD auto sum_motion(const Stencil<Real>& s, Node node, Moment)
{
    constexpr bool moment = std::is_same_v<Moment, WithMoment>;
    using Sums            = Partial<decltype(node(0, 0, 0).velocity)>;
    Sums all{};
    for (int c = 0; c < 3; ++c)
    {
        Sums layer{};
        for (int b = 0; b < 3; ++b)
        {
            Sums row{};
            for (int a = 0; a < 3; ++a)
            {
                const auto& motion = node(a, b, c);
                const Real  weight = s.weight[0][a];
                add_scaled(weight, motion.velocity, row.velocity);
                add_scaled(s.slope[0][a], motion.velocity, row.by_x);
                add_scaled(weight, motion.change, row.change);
                if (moment && a > 0) { add_scaled(Real(a) * weight, motion.velocity, row.at_x); }
            }
            const Real weight = s.weight[1][b];
            add_scaled(weight, row.velocity, layer.velocity);
            add_scaled(weight, row.by_x, layer.by_x);
            add_scaled(s.slope[1][b], row.velocity, layer.by_y);
            add_scaled(weight, row.change, layer.change);
            if (moment)
            {
                add_scaled(weight, row.at_x, layer.at_x);
                if (b > 0) { add_scaled(Real(b) * weight, row.velocity, layer.at_y); }
            }
        }
        const Real weight = s.weight[2][c];
        add_scaled(weight, layer.velocity, all.velocity);
        add_scaled(weight, layer.by_x, all.by_x);
        add_scaled(weight, layer.by_y, all.by_y);
        add_scaled(s.slope[2][c], layer.velocity, all.by_z);
        add_scaled(weight, layer.change, all.change);
        if (moment)
        {
            add_scaled(weight, layer.at_x, all.at_x);
            add_scaled(weight, layer.at_y, all.at_y);
            if (c > 0) { add_scaled(Real(c) * weight, layer.velocity, all.at_z); }
        }
    }
    return all;
}

/// Writes component `i` of the motion at a point from component `from` of the sums over its stencil.
template<class Real, class Numbers, class Moment>
TREAD_HD void set_seen(Seen<Real>& seen, int i, const Partial<Numbers>& sum, int from, const Stencil<Real>& s,
                       Real spacing, Moment)
{
    seen.velocity[i] = sum.velocity[from];
    seen.change[i]   = sum.change[from];
    seen.gradient.row(i) << sum.by_x[from], sum.by_y[from], sum.by_z[from];
    if constexpr (std::is_same_v<Moment, WithMoment>)
    {
        seen.moment.row(i) << spacing * (sum.at_x[from] - s.fraction[0] * sum.velocity[from]),
            spacing * (sum.at_y[from] - s.fraction[1] * sum.velocity[from]),
            spacing * (sum.at_z[from] - s.fraction[2] * sum.velocity[from]);
    }
}

/// Sets the affine velocity field of affine transfers (APIC, AFLIP): 4/h^2 times the moment for quadratic splines
/// (Jiang et al. 2015), the velocity gradient for linear ones.
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

/// Computes the velocity after the step: FLIP with a PIC share. The share is the same for all materials: for points
/// that share nodes, sum m (v_grid - v_flip) = 0 holds only for all together, so that shares by material would not
/// conserve momentum.
template<class Real>
TREAD_HD Vec3<Real> transferred_velocity(const Vec3<Real>& before, const Seen<Real>& seen, Real pic)
{
    return (Real(1) - pic) * (before + seen.change) + pic * seen.velocity;
}

template<class Real, class Sum>
TREAD_HD void keep_for_contact(const PointsView<Real>& points, std::int64_t i, Real mass, const Seen<Real>& seen,
                               Real dt, Sum* sums)
{
    const Vec3<Real> force = points.contact_force.get(i);
    points.grid_velocity.set(i, seen.velocity);
    points.support.set(i, seen.change / dt - force / mass);
    sums[point_contact_power] += Sum(force.dot(seen.velocity - seen.change));
    sums[point_contact_work] += Sum(dt) * Sum(force.dot(seen.velocity - Real(0.5) * seen.change));
}

/// Computes the power of `stress` (Pa) on the symmetric part of `gradient` (1/s), W/m3.
template<class Real>
TREAD_HD Real stress_power(const Sym3<Real>& stress, const Mat3<Real>& gradient)
{
    return stress[0] * gradient(0, 0) + stress[1] * gradient(1, 1) + stress[2] * gradient(2, 2) +
           stress[3] * (gradient(1, 2) + gradient(2, 1)) + stress[4] * (gradient(0, 2) + gradient(2, 0)) +
           stress[5] * (gradient(0, 1) + gradient(1, 0));
}

/// Updates material state and returns the new stress. `gradient`: at mid-step, as in law_gradient.
template<class Real, class Sum>
TREAD_HD Sym3<Real> update_material(const PointsView<Real>& points, std::int64_t i, const PointState<Real>& point,
                                    const Mat3<Real>& gradient, const GatherStep<Real>& step, Sum* sums)
{
    const MaterialParameters<Real>& material = step.materials[point.material];
    const Real                      swelling = step.dt * gradient.trace(); // logarithmic volume change
    points.volume_ratio[i]          = point.volume_ratio * (Real(1) + swelling * (Real(1) + Real(0.5) * swelling));
    const bool               capped = points.cap_pressure != nullptr;
    const PlasticState<Real> state{point.plastic_shear,
                                   Real(0),
                                   point.volume_gap,
                                   point.volume_ratio,
                                   capped ? points.cap_pressure[i] : Real(0),
                                   points.mean_strain != nullptr ? points.mean_strain[i] : Real(0)};
    const StressUpdate<Real> update = update_stress(material, point.stress, state, gradient, step.dt);
    points.stress.set(i, update.stress);
    sums[point_stress_power] += Sum(point.volume * stress_power(update.stress, gradient));
    sums[point_strain] += Sum(point.volume * elastic_energy_density(material, update.stress));
    if (points.plastic_shear != nullptr)
    {
        points.plastic_shear[i] = update.state.plastic_shear;
        points.plastic_rate[i]  = update.state.plastic_rate;
        points.volume_gap[i]    = update.state.volume_gap;
        const Real work         = update.plastic_work + update.work_to_mean;
        if (work != 0) { sums[point_plastic_work] += Sum(work * point.volume); }
        if (capped) { points.cap_pressure[i] = update.state.cap_pressure; }
    }
    return update.stress;
}

/// Computes the velocity gradient at mid-step for the law; with cell means its trace is that of the cell. Adds the
/// power of the stress at the start on the correction from the gradient at the start to that at mid-step: the forces of
/// P2G do work on the gradient at the start, but the law stores the work on the mid-step gradient, and the power at the
/// end of the step is lower than that on the mid-step gradient by the same difference. Without this term, rotating
/// stress would create or lose energy.
template<class Real, class Sum>
TREAD_HD Mat3<Real> law_gradient(const PointState<Real>& point, const Mat3<Real>& gradient,
                                 const GatherStep<Real>& step, std::int64_t cell, Sum* sums)
{
    const Mat3<Real> change = to_mid_step(gradient, step.dt);
    sums[point_stress_power] += Sum(point.volume * stress_power(point.stress, change));
    Mat3<Real> middle = gradient + change;
    if (step.cell_divergence == nullptr) { return middle; }
    return middle + (step.cell_divergence[cell] - middle.trace()) * Real(1.0 / 3) * Mat3<Real>::Identity();
}

/// Performs G2P of one point of a page; returns its move.
template<class Real, class Sum>
TREAD_HD Move update_point(const PointsView<Real>& points, std::int64_t i, const PointState<Real>& point,
                           const Seen<Real>& seen, Index3 cell, const PagesView& pages, std::int64_t page,
                           const GatherStep<Real>& step, Sum* sums, Sum* peaks)
{
    const Vec3<Real> velocity = transferred_velocity(point.velocity, seen, step.pic);
    points.velocity.set(i, velocity);
    if (points.affine.data != nullptr) { set_affine(points, i, seen, pages.spacing, pages.stencil_shift); }
    if (points.contact_force.data != nullptr) { keep_for_contact(points, i, point.mass, seen, step.dt, sums); }
    const std::int64_t place = page * page_cells + place_in_page(cell);
    const Sym3<Real>   stress =
        update_material(points, i, point, law_gradient(point, seen.gradient, step, place, sums), step, sums);

    const Vec3<double> position = point.position + double(step.dt) * seen.velocity.template cast<double>();
    points.position.set(i, position);

    const Real speed_squared = velocity.squaredNorm(), checked = speed_squared + stress.sum();
    sums[point_kinetic] += Sum(Real(0.5) * point.mass * speed_squared);
    const bool finite = std::isfinite(checked);
    const Move move =
        finite ? move_to(pages, page, cell, position) : Move{own_page, place_in_page(cell), CellChange::not_finite};
    peaks[peak_speed_squared] = std::fmax(peaks[peak_speed_squared], finite ? Sum(speed_squared) : Sum(0));
    peaks[peak_cell_change]   = std::fmax(peaks[peak_cell_change], static_cast<Sum>(move.cell_change));
    return move;
}

} // namespace tread::mpm
