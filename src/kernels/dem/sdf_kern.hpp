#pragma once

#include <cmath>
#include <cstdint>

#include "backend/vector.hpp"
#include "kernels/dem/templates.hpp"

// Signed distance of a body: the trilinear interpolant of its template's grid, and the exact gradient of that same
// interpolant. One potential then gives both the depth and the direction of a contact force (verification B).
namespace tread::dem
{

struct SdfSample
{
    double       distance; ///< m, negative inside
    Vec3<double> gradient; ///< not normalised
};

/// The interpolant at `cell` spacings from the grid's origin, each component in [0, nodes - 1]; gradient by metres.
TREAD_HD SdfSample interpolate_sdf(const TemplateView& shape, const Vec3<double>& cell)
{
    std::int64_t low[3];
    Vec3<double> t;
    for (int c = 0; c < 3; ++c)
    {
        const std::int32_t last = shape.sdf_nodes[c] - 2;
        const auto         i    = static_cast<std::int32_t>(cell[c]);
        low[c]                  = i < last ? i : last;
        t[c]                    = cell[c] - static_cast<double>(low[c]);
    }
    const std::int64_t row = shape.sdf_nodes[0], layer = row * shape.sdf_nodes[1];
    const float*       at      = shape.sdf_values + low[0] + row * low[1] + layer * low[2];
    const auto         along_x = [&](std::int64_t line, double& slope)
    {
        const double first = static_cast<double>(at[line]);
        slope              = static_cast<double>(at[line + 1]) - first;
        return first + t[0] * slope;
    };
    double       slope00, slope10, slope01, slope11;
    const double value00 = along_x(0, slope00), value10 = along_x(row, slope10);
    const double value01 = along_x(layer, slope01), value11 = along_x(layer + row, slope11);
    const double low_z = value00 + t[1] * (value10 - value00), high_z = value01 + t[1] * (value11 - value01);

    const double by_x =
        (1 - t[2]) * (slope00 + t[1] * (slope10 - slope00)) + t[2] * (slope01 + t[1] * (slope11 - slope01));
    const double by_y = (value10 - value00) + t[2] * ((value11 - value01) - (value10 - value00));
    return {low_z + t[2] * (high_z - low_z), Vec3<double>(by_x, by_y, high_z - low_z) / shape.sdf_spacing};
}

/// Distance and gradient at a point of the template's frame (m, scale 1). Outside the grid a lower bound of the
/// distance, positive and continuous: the root of the squares of the distance to the grid's box and of the value (at
/// least 0) at the box's nearest point, with its exact gradient.
TREAD_HD SdfSample sample_template_sdf(const TemplateView& shape, const Vec3<double>& point)
{
    const Vec3<double> cell = (point - shape.sdf_origin) / shape.sdf_spacing;
    Vec3<double>       nearest;
    for (int c = 0; c < 3; ++c)
    {
        nearest[c] = std::fmin(std::fmax(cell[c], 0.0), static_cast<double>(shape.sdf_nodes[c] - 1));
    }
    SdfSample sample = interpolate_sdf(shape, nearest);
    if (nearest == cell) { return sample; }

    const Vec3<double> gap    = (cell - nearest) * shape.sdf_spacing;
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

/// The same for an instance in the world: phi(x) = s phi_template(R^T (x - c) / s), gradient R grad phi_template.
/// position = centre of mass c (m), orientation = body to world.
TREAD_HD SdfSample sample_body_sdf(const TemplateView& shape, double scale, const Vec3<double>& position,
                                   const Quat& orientation, const Vec3<double>& world_point)
{
    const Mat3<double> rotation = orientation.toRotationMatrix();
    const Vec3<double> local    = rotation.transpose() * (world_point - position) / scale;
    const SdfSample    sample   = sample_template_sdf(shape, local);
    return {scale * sample.distance, rotation * sample.gradient};
}

/// How far the interpolant of a body may be from the distance that it interpolates: a weighted mean of values at most
/// a cell's diagonal away, of a function with slope 1.
TREAD_HD double sdf_uncertainty(const TemplateView& shape, double scale)
{
    return std::sqrt(3.0) * shape.sdf_spacing * scale;
}

} // namespace tread::dem
