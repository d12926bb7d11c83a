#pragma once

#include <cmath>
#include <type_traits>

#include "kernels/dem/contact/ray_field_kern.hpp"

// Which nodes of one body may enter the other before pairs are found again. A list may hold a node too many, so that
// single precision suffices where bounds allow for its rounding.
namespace tread::dem
{

/// Upper bound of the rounding of the field at a node, over the lengths that it is computed from: the place is off by
/// at most 6 sqrt(3) 2^-24 of them, the field by sqrt(3), its steepest slope, times this and by ten 2^-24 of its
/// values.
inline constexpr double field_rounding = 2e-6;

/// Places of a body's nodes in the grid of another body's field, in cells.
struct NodesInGrid
{
    const TemplateView* field;
    Mat3<float>         turn;     ///< cells / m, from the template frame of the nodes' body
    Vec3<float>         shift;    ///< cells
    double              per_m;    ///< lengths in the field's template over those of its body
    double              rounding; ///< m, of the field

    /// Returns a bound of the field (m), raised by the rounding, as a length in its template.
    TREAD_HD float bound(double of_field) const { return static_cast<float>(per_m * (of_field + rounding)); }

    /// Whether the field at a position of the nodes' template is at most `bound`, m of the field's template. Outside
    /// its grid the field is that of sample_template_sdf.
    TREAD_HD bool is_near(const Vec3<double>& x, float bound) const
    {
        const Vec3<float> y  = x.cast<float>();
        const Vec3<float> at = shift + y[0] * turn.col(0) + y[1] * turn.col(1) + y[2] * turn.col(2);
        Vec3<float>       nearest;
        for (int c = 0; c < 3; ++c)
        {
            nearest[c] = std::fmin(std::fmax(at[c], 0.0F), static_cast<float>(field->sdf.nodes[c] - 1));
        }
        const float value = interpolate_in(find_cell(*field, nearest));
        const float gap   = static_cast<float>(field->sdf.spacing * field->sdf.spacing) * (at - nearest).squaredNorm();
        if (gap == 0) { return value <= bound; }
        const float positive = std::fmax(value, 0.0F);
        return bound > 0 && gap + positive * positive <= bound * bound;
    }
};

/// Distances of a body's nodes from a wall.
struct NodesOverWall
{
    Vec3<float> normal;   ///< in the template frame of the nodes' body, times its scale
    float       offset;   ///< m
    double      rounding; ///< m

    TREAD_HD float bound(double of_field) const { return static_cast<float>(of_field + rounding); }
    TREAD_HD bool  is_near(const Vec3<double>& x, float bound) const
    {
        return normal.dot(x.cast<float>()) - offset <= bound;
    }
};

TREAD_HD NodesInGrid place_nodes(const Instance& owner, const BodyField& field)
{
    const Instance&    body   = field.body;
    const SdfGridView& grid   = body.shape->sdf;
    const Mat3<double> turned = body.rotation.transpose() * owner.rotation;
    const Vec3<double> apart  = body.rotation.transpose() * (owner.centre - body.centre);
    const double       cells  = body.inverse_scale * grid.inverse_spacing;
    const double       width  = body.scale * grid.spacing * (grid.nodes[0] + grid.nodes[1] + grid.nodes[2]);
    return {body.shape, (cells * owner.scale * turned).cast<float>(),
            (cells * apart - grid.inverse_spacing * grid.origin).cast<float>(), body.inverse_scale,
            field_rounding * (owner.scale * owner.shape->bounding_radius + apart.lpNorm<1>() + width)};
}

TREAD_HD NodesInGrid place_nodes(const Instance& owner, const RayField& field)
{
    return place_nodes(owner, field.solid);
}

TREAD_HD NodesOverWall place_nodes(const Instance& owner, const PlaneField& field)
{
    const double offset = field.offset - field.normal.dot(owner.centre);
    return {(owner.scale * (owner.rotation.transpose() * field.normal)).cast<float>(), static_cast<float>(offset),
            field_rounding * (owner.scale * owner.shape->bounding_radius + std::fabs(offset))};
}

/// The nodes of a side that may enter when the two bodies move by at most `way` together.
template<class Field, class Places>
struct NearNodes
{
    const TemplateView* shape; ///< of the nodes' body
    double              scale; ///< of the nodes' body
    double              sign;  ///< of the side
    Field               field;
    double              way; ///< m
    Places              places;
    float               bound_of_node; ///< as Places::bound

    /// Returns false only if no node of the cluster may enter (the distance of the other body has slope 1).
    TREAD_HD bool has_cluster(std::int32_t cluster) const
    {
        const double reach = scale * shape->cluster_radii[cluster] + way;
        return places.is_near(shape->cluster_centres[cluster], places.bound(field.bound(reach)));
    }

    TREAD_HD bool has_node(std::int32_t i) const { return places.is_near(shape->node_positions[i], bound_of_node); }
};

template<class Field>
TREAD_HD auto near_nodes(const Side<Field>& side, double way)
{
    const auto places = place_nodes(side.owner, side.field);
    return NearNodes<Field, std::remove_const_t<decltype(places)>>{side.owner.shape,
                                                                   side.owner.scale,
                                                                   side.sign,
                                                                   side.field,
                                                                   way,
                                                                   places,
                                                                   places.bound(side.field.bound_of_node(way))};
}

} // namespace tread::dem
