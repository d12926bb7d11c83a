#pragma once

#include <cmath>

#include "kernels/dem/contact/ray_field_kern.hpp"

// Which nodes of one body may enter the other before pairs are found again. A list may hold a node too many, so that
// single precision suffices where bounds allow for its rounding.
namespace tread::dem
{

/// Upper bound of the rounding of the field at a node, over the lengths that it is computed from: the place is off by
/// at most 6 sqrt(3) 2^-24 of them, the field by sqrt(3), its steepest slope, times this and by ten 2^-24 of its
/// values, a bound by three.
inline constexpr double field_rounding = 2e-6;

/// Places nodes that may come nearer to a body by `way`, m.
TREAD_HD PlacedNodes place_nodes(const Instance& owner, const BodyField& field, double way, double bound)
{
    const Instance&    body   = field.body;
    const SdfGridView& grid   = body.shape->sdf;
    const Mat3<double> turned = body.rotation.transpose() * owner.rotation;
    const Vec3<double> apart  = body.rotation.transpose() * (owner.centre - body.centre);
    const double       cells  = body.inverse_scale * grid.inverse_spacing;
    const double       width  = body.scale * grid.spacing * (grid.nodes[0] + grid.nodes[1] + grid.nodes[2]);
    const double rounding = field_rounding * (owner.scale * owner.shape->bounding_radius + apart.lpNorm<1>() + width);
    const auto   length   = [&](double l) { return static_cast<float>(body.inverse_scale * l); };
    return {(cells * owner.scale * turned).cast<float>(),
            (cells * apart - grid.inverse_spacing * grid.origin).cast<float>(),
            length(bound + rounding),
            length(owner.scale),
            length(way + rounding),
            static_cast<float>(rounding)};
}

/// Places nodes that may come nearer to a wall by `way`, m.
TREAD_HD PlacedNodes place_nodes(const Instance& owner, const PlaneField& field, double way, double bound)
{
    const double       offset   = field.offset - field.normal.dot(owner.centre);
    const double       rounding = field_rounding * (owner.scale * owner.shape->bounding_radius + std::fabs(offset));
    const Vec3<double> normal   = owner.scale * (owner.rotation.transpose() * field.normal);
    PlacedNodes        placed;
    placed.turn.setZero();
    placed.turn.row(0) = normal.cast<float>().transpose();
    placed.shift       = Vec3<float>(static_cast<float>(-offset), 0, 0);
    placed.bound       = static_cast<float>(bound + rounding);
    placed.scale       = static_cast<float>(owner.scale);
    placed.way         = static_cast<float>(way + rounding);
    placed.rounding    = static_cast<float>(rounding);
    return placed;
}

TREAD_HD PlacedNodes place_nodes(const Instance& owner, const RayField& field, double way, double bound)
{
    return place_nodes(owner, field.solid, way, bound);
}

/// Places the nodes of a side whose bodies move by at most `way` together, m.
template<class Field>
TREAD_HD PlacedNodes place_nodes(const Side<Field>& side, double way)
{
    return place_nodes(side.owner, side.field, way, side.field.bound_of_node(way));
}

/// The nodes of a body that may enter another body, or a wall.
struct NearNodes
{
    const TemplateView* shape; ///< of the nodes' body
    const TemplateView* field; ///< of the other; null: a wall
    PlacedNodes         placed;
    Vec3<float>         last{0, 0, 0}; ///< node of the field's grid
    float               square = 0;    ///< m2, of its spacing

    /// Returns false only if no node of the part may enter (the distance of the other body has slope 1).
    TREAD_HD bool has_part(std::int32_t part) const
    {
        const double reach = placed.scale * shape->part_radii[part] + placed.way;
        return is_near(shape->part_centres[part],
                       static_cast<float>(field == nullptr ? reach : bound_within(*field, 1, reach)));
    }

    TREAD_HD bool has_node(std::int32_t i) const { return is_near(shape->node_positions[i], placed.bound); }

private:
    /// Whether the field at a position of the nodes' template is at most `bound`. Outside its grid the field is that of
    /// sample_template_sdf.
    TREAD_HD bool is_near(const Vec3<double>& x, float bound) const
    {
        const Vec3<float> y = x.cast<float>();
        const Vec3<float> at =
            placed.shift + y[0] * placed.turn.col(0) + y[1] * placed.turn.col(1) + y[2] * placed.turn.col(2);
        if (field == nullptr) { return at[0] <= bound; }
        Vec3<float> nearest;
        for (int c = 0; c < 3; ++c) { nearest[c] = std::fmin(std::fmax(at[c], 0.0F), last[c]); }
        const float value = interpolate_in(find_cell(*field, nearest));
        const float gap   = square * (at - nearest).squaredNorm();
        if (gap == 0) { return value <= bound; }
        const float positive = std::fmax(value, 0.0F);
        return bound > 0 && gap + positive * positive <= bound * bound;
    }
};

/// `field`: template of the other body; null for a wall.
TREAD_HD NearNodes near_nodes(const TemplateView* shape, const TemplateView* field, const PlacedNodes& placed)
{
    NearNodes near{shape, field, placed};
    if (field == nullptr) { return near; }
    for (int c = 0; c < 3; ++c) { near.last[c] = static_cast<float>(field->sdf.nodes[c] - 1); }
    near.square = static_cast<float>(field->sdf.spacing * field->sdf.spacing);
    return near;
}

} // namespace tread::dem
