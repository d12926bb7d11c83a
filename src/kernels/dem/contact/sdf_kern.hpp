#pragma once

#include <cmath>
#include <cstdint>

#include "backend/vector.hpp"
#include "kernels/dem/templates.hpp"

// Signed distance of a body: the trilinear interpolant of its template's grid, and the exact gradient of that
// interpolant. Depth and direction of a contact force then derive from one potential (docs/theory.md#distance-fields).
namespace tread::dem
{

struct SdfSample
{
    double       distance; ///< m, negative inside
    Vec3<double> gradient; ///< not normalised
};

inline constexpr std::int32_t brick_shift = 3; ///< a brick has 8 cells along each axis
inline constexpr std::int32_t brick_cells = 1 << brick_shift, brick_nodes = brick_cells + 1;

/// The cell used for interpolation at a position. Strides have 32 bits: grids of more than shape::most_dense_nodes are
/// in bricks.
template<class Real>
struct SdfCell
{
    const float* low;   ///< its lowest corner; x is contiguous
    std::int32_t row;   ///< stride along y
    std::int32_t layer; ///< stride along z
    Vec3<Real>   fraction;
    double       inverse_spacing; ///< 1/m
};

/// Finds the cell of a bricked grid; `index` = its lowest node, `at` = position, both in fine cells.
template<class Real>
TREAD_HD SdfCell<Real> brick_cell(const TemplateView& shape, const std::int32_t* index, const Vec3<Real>& at)
{
    std::int32_t brick[3], inner[3];
    for (int c = 0; c < 3; ++c)
    {
        brick[c] = index[c] >> brick_shift;
        inner[c] = index[c] & (brick_cells - 1);
    }
    const std::int32_t nx = shape.sdf.bricks[0], ny = shape.sdf.bricks[1];
    const std::int64_t slot = shape.sdf.slots[brick[0] + nx * (brick[1] + ny * brick[2])];
    SdfCell<Real>      cell;
    if (slot >= 0)
    {
        cell.row   = brick_nodes;
        cell.layer = brick_nodes * brick_nodes;
        cell.low =
            shape.sdf.values + brick_nodes * cell.layer * slot + inner[0] + cell.row * inner[1] + cell.layer * inner[2];
        for (int c = 0; c < 3; ++c) { cell.fraction[c] = at[c] - static_cast<Real>(index[c]); }
        cell.inverse_spacing = shape.sdf.inverse_spacing;
        return cell;
    }
    cell.row   = nx + 1;
    cell.layer = cell.row * (ny + 1);
    cell.low   = shape.sdf.corners + brick[0] + cell.row * brick[1] + cell.layer * brick[2];
    for (int c = 0; c < 3; ++c)
    {
        cell.fraction[c] = (at[c] - static_cast<Real>(brick_cells * brick[c])) / brick_cells;
    }
    cell.inverse_spacing = shape.sdf.inverse_spacing / brick_cells;
    return cell;
}

/// Finds the cell at `at` spacings from the grid's origin, each component in [0, nodes - 1].
template<class Real>
TREAD_HD SdfCell<Real> find_cell(const TemplateView& shape, const Vec3<Real>& at)
{
    std::int32_t index[3];
    for (int c = 0; c < 3; ++c)
    {
        const std::int32_t last = shape.sdf.nodes[c] - 2;
        const auto         i    = static_cast<std::int32_t>(at[c]);
        index[c]                = i < last ? i : last;
    }
    if (shape.sdf.slots != nullptr) { return brick_cell(shape, index, at); }
    SdfCell<Real> cell;
    cell.row   = shape.sdf.nodes[0];
    cell.layer = cell.row * shape.sdf.nodes[1];
    cell.low   = shape.sdf.values + index[0] + cell.row * index[1] + cell.layer * index[2];
    for (int c = 0; c < 3; ++c) { cell.fraction[c] = at[c] - static_cast<Real>(index[c]); }
    cell.inverse_spacing = shape.sdf.inverse_spacing;
    return cell;
}

/// Returns the interpolant in a cell, m.
template<class Real>
TREAD_HD Real interpolate_in(const SdfCell<Real>& cell)
{
    const auto mixed   = [](Real low, Real high, Real part) { return low + part * (high - low); };
    const auto along_x = [&](std::int32_t line)
    { return mixed(static_cast<Real>(cell.low[line]), static_cast<Real>(cell.low[line + 1]), cell.fraction[0]); };
    const Real low_z  = mixed(along_x(0), along_x(cell.row), cell.fraction[1]);
    const Real high_z = mixed(along_x(cell.layer), along_x(cell.layer + cell.row), cell.fraction[1]);
    return mixed(low_z, high_z, cell.fraction[2]);
}

/// Returns the interpolant at `at` spacings from the grid's origin, each component in [0, nodes - 1]; gradient per
/// metre.
TREAD_HD SdfSample interpolate_sdf(const TemplateView& shape, const Vec3<double>& at)
{
    const SdfCell<double> cell    = find_cell(shape, at);
    const Vec3<double>&   t       = cell.fraction;
    const auto            along_x = [&](std::int32_t line, double& slope)
    {
        const double first = static_cast<double>(cell.low[line]);
        slope              = static_cast<double>(cell.low[line + 1]) - first;
        return first + t[0] * slope;
    };
    double       slope00, slope10, slope01, slope11;
    const double value00 = along_x(0, slope00), value10 = along_x(cell.row, slope10);
    const double value01 = along_x(cell.layer, slope01), value11 = along_x(cell.layer + cell.row, slope11);
    const double low_z = value00 + t[1] * (value10 - value00), high_z = value01 + t[1] * (value11 - value01);

    const double by_x =
        (1 - t[2]) * (slope00 + t[1] * (slope10 - slope00)) + t[2] * (slope01 + t[1] * (slope11 - slope01));
    const double by_y = (value10 - value00) + t[2] * ((value11 - value01) - (value10 - value00));
    return {low_z + t[2] * (high_z - low_z), cell.inverse_spacing * Vec3<double>(by_x, by_y, high_z - low_z)};
}

/// Returns distance and gradient at a point of the template's frame (m, scale 1). Outside the grid it is a lower bound
/// of the distance, positive and continuous: the root of the sum of the squares of the distance to the grid's box and
/// of the value (at least 0) at the box's nearest point, with its exact gradient.
TREAD_HD SdfSample sample_template_sdf(const TemplateView& shape, const Vec3<double>& point)
{
    const Vec3<double> cell = (point - shape.sdf.origin) * shape.sdf.inverse_spacing;
    Vec3<double>       nearest;
    for (int c = 0; c < 3; ++c)
    {
        nearest[c] = std::fmin(std::fmax(cell[c], 0.0), static_cast<double>(shape.sdf.nodes[c] - 1));
    }
    SdfSample sample = interpolate_sdf(shape, nearest);
    if (nearest == cell) { return sample; }

    const Vec3<double> gap    = (cell - nearest) * shape.sdf.spacing;
    const double       inside = std::fmax(sample.distance, 0.0);
    const double       bound  = std::sqrt(gap.squaredNorm() + inside * inside);
    for (int c = 0; c < 3; ++c)
    {
        const bool within  = nearest[c] == cell[c];
        sample.gradient[c] = (within ? inside * sample.gradient[c] : gap[c]) / bound;
    }
    sample.distance = bound;
    return sample;
}

/// Returns distance and gradient of an instance in the world frame: phi(x) = s phi_template(R^T (x - c) / s), gradient
/// R grad phi_template. position = centre of mass c (m), orientation = body to world.
TREAD_HD SdfSample sample_body_sdf(const TemplateView& shape, double scale, const Vec3<double>& position,
                                   const Quat& orientation, const Vec3<double>& world_point)
{
    const Mat3<double> rotation = orientation.toRotationMatrix();
    const Vec3<double> local    = rotation.transpose() * (world_point - position) / scale;
    const SdfSample    sample   = sample_template_sdf(shape, local);
    return {scale * sample.distance, rotation * sample.gradient};
}

/// Maximum error of the interpolant with respect to the interpolated distance, in a cell of the given edge. It is at
/// most the weighted mean distance to the cell's corners (the function has slope 1), which is at most the root of sum t
/// (1 - t) over the axes, half the diagonal in the middle.
TREAD_HD double cell_uncertainty(double edge) { return 0.5 * std::sqrt(3.0) * edge; }

/// Maximum error at the surface, where every cell is fine.
TREAD_HD double surface_uncertainty(const TemplateView& shape, double scale)
{
    return cell_uncertainty(shape.sdf.spacing) * scale;
}

/// Maximum error at any position no further than `distance` (m, true) outside the surface. Nearer than fine_reach
/// all corners of a cell are exact. Beyond, a cell may be a whole brick or have corners on the face of one: these have
/// an error of half the face's diagonal, which together with the error of a fine cell is still below that of a brick.
TREAD_HD double sdf_uncertainty(const TemplateView& shape, double scale, double distance)
{
    const bool fine = shape.sdf.slots == nullptr || distance <= scale * shape.sdf.fine_reach;
    return cell_uncertainty((fine ? 1 : brick_cells) * shape.sdf.spacing) * scale;
}

/// Upper bound of the interpolant, m, at positions no further than r (m, true) outside the surface.
TREAD_HD double bound_within(const TemplateView& shape, double scale, double r)
{
    const double furthest = r + surface_uncertainty(shape, scale);
    return furthest + sdf_uncertainty(shape, scale, furthest);
}

/// Upper bound of the interpolant at every position from which a point can come within `radius` of the interpolated
/// surface when it moves by at most half of `displacement`, m, and at every nearer position.
/// The slope of the interpolant is at most sqrt(3) where cells are exact: there radius + displacement is a bound. A
/// path that leaves this region starts at fine_reach or beyond; to end within `radius`, that distance must be below the
/// sum below. In that case the distance at the start (at most radius + uncertainty + displacement/2) and its error are
/// added.
TREAD_HD double search_bound(const TemplateView& shape, double scale, double radius, double displacement)
{
    const double bound = radius + displacement, at_surface = surface_uncertainty(shape, scale);
    if (shape.sdf.slots == nullptr || bound + at_surface <= scale * shape.sdf.fine_reach) { return bound; }
    return bound + at_surface + cell_uncertainty(brick_cells * shape.sdf.spacing) * scale;
}

/// Upper bound of the interpolant at every position from which a point can reach the interpolated surface when it moves
/// by at most `way`, m, and at every nearer one: as search_bound, with the actual maximum slope of the interpolant.
TREAD_HD double approach_bound(const TemplateView& shape, double scale, double way)
{
    const double bound = shape.sdf.steepest * way, at_surface = surface_uncertainty(shape, scale);
    if (shape.sdf.slots == nullptr || bound + at_surface <= scale * shape.sdf.fine_reach) { return bound; }
    return 2.0 * way + at_surface + cell_uncertainty(brick_cells * shape.sdf.spacing) * scale;
}

} // namespace tread::dem
