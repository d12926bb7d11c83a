#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/dem/bodies.hpp"
#include "kernels/dem/contact/contact_body.hpp"
#include "kernels/dem/contact/sdf_kern.hpp"

// Fields of bodies and walls, and the nodes of one body in the field of another. All positions are relative to the
// centre of a pair's first body, a, along the world axes.
namespace tread::dem
{

/// A body placed relative to the centre of body a.
struct Instance
{
    const TemplateView* shape;
    double              scale;
    double              inverse_scale;
    Mat3<double>        rotation; ///< body to world
    Vec3<double>        centre;   ///< m
};

TREAD_HD Instance instance_of(const BodiesView& bodies, const TemplateView* templates, std::int64_t b,
                              const Vec3<double>& origin)
{
    return {templates + bodies.shape[b], bodies.scale[b], 1.0 / bodies.scale[b],
            bodies.orientation[b].toRotationMatrix(), bodies.position[b] - origin};
}

TREAD_HD Instance instance_of(const ContactBody& body, const TemplateView* templates, const Vec3<double>& origin)
{
    return {templates + body.shape, body.scale, 1.0 / body.scale, body.orientation.toRotationMatrix(),
            body.position - origin};
}

/// A node evaluated in the field of the other body.
struct NodeInField
{
    Vec3<double> place;    ///< m, point of action of its force, relative to the centre of a
    Vec3<double> gradient; ///< minus the gradient of the overlap with respect to the node's position
    double       overlap;  ///< m; outside if not positive
    double       weight;   ///< m2, area assigned to the node
    double       sign;     ///< +1 for a node of a, -1 for one of b
};

/// Result of evaluating a node, for the sums over a pair. It is rounded to fp32 only after the overlap was computed in
/// fp64.
struct alignas(16) FoundNode
{
    float place[3];
    float overlap;
    float gradient[3]; ///< multiplied by the sign
    float weight;
};

TREAD_HD FoundNode packed(const NodeInField& node)
{
    FoundNode found;
    for (int c = 0; c < 3; ++c)
    {
        found.place[c]    = static_cast<float>(node.place[c]);
        found.gradient[c] = static_cast<float>(node.sign * node.gradient[c]);
    }
    found.overlap = static_cast<float>(node.overlap);
    found.weight  = static_cast<float>(node.weight);
    return found;
}

TREAD_HD NodeInField unpacked(const FoundNode& found)
{
    return {Vec3<double>(found.place[0], found.place[1], found.place[2]),
            Vec3<double>(found.gradient[0], found.gradient[1], found.gradient[2]), found.overlap, found.weight, 1.0};
}

/// Distance field of a body.
struct BodyField
{
    const Instance& body;

    /// Upper bound, m, of the field at positions that enter the body when they move by at most `way`.
    TREAD_HD double bound_of_node(double way) const { return approach_bound(*body.shape, body.scale, way); }

    TREAD_HD SdfSample operator()(const Vec3<double>& y) const
    {
        const Vec3<double> local  = body.inverse_scale * (body.rotation.transpose() * (y - body.centre));
        const SdfSample    sample = sample_template_sdf(*body.shape, local);
        return {body.scale * sample.distance, body.rotation * sample.gradient};
    }
};

/// Distance field of a wall.
struct PlaneField
{
    Vec3<double> normal;
    double       offset; ///< m, relative to the centre of body a

    TREAD_HD double bound_of_node(double way) const { return way; }

    TREAD_HD SdfSample operator()(const Vec3<double>& y) const { return {normal.dot(y) - offset, normal}; }
};

/// The nodes of one body in the field of the other. Field: one of those above, or RayField.
template<class Field>
struct Side
{
    const Instance& owner;
    Field           field;
    double          share; ///< factor of a node's area: 1/2 if both bodies have nodes, 1 against a plane
    double          sign;  ///< +1 if the nodes are of body a, -1 if of b

    TREAD_HD Vec3<double> node(std::int32_t i) const
    {
        return owner.centre + owner.rotation * (owner.scale * owner.shape->node_positions[i]);
    }

    TREAD_HD double weight(std::int32_t i) const
    {
        return share * owner.scale * owner.scale * owner.shape->node_areas[i];
    }
};

/// Returns the field of a wall relative to the centre of body a.
TREAD_HD PlaneField field_of(const Plane& plane, const Vec3<double>& centre)
{
    return {plane.normal, plane.offset - plane.normal.dot(centre)};
}

/// Lanes of a single thread; on a GPU several lanes share the nodes of a pair.
struct OneLane
{
    TREAD_HD std::int32_t lane() const { return 0; }
    TREAD_HD std::int32_t lanes() const { return 1; }
    TREAD_HD std::uint32_t vote(bool value) const { return value ? 1u : 0u; } ///< bit l = the value of lane l
    TREAD_HD std::uint32_t share(std::uint32_t bits) const { return bits; }   ///< bits of this lane: strided
    TREAD_HD void          sync() const {}
    TREAD_HD double        sum(double value) const { return value; }
    TREAD_HD double        largest(double value) const { return value; }
    TREAD_HD double        from(std::int32_t, double value) const { return value; } ///< value of another lane
};

/// Nodes of a cluster and of each of its parts, as in shape::SurfaceNodes.
inline constexpr std::int32_t cluster_size = 32, part_size = 8;

template<class Field>
TREAD_HD NodeInField in_field(const Side<Field>& side, std::int32_t i)
{
    const Vec3<double> place  = side.node(i);
    const SdfSample    sample = side.field(place);
    return {place, sample.gradient, -sample.distance, side.weight(i), side.sign};
}

/// The two bodies of a pair.
struct Couple
{
    Instance body[2];
};

/// The two sides of a pair of bodies, selected by the node names in the list. Meet: narrow phase.
template<class Meet>
struct TwoSides
{
    Meet          meet;
    const Couple& couple;

    TREAD_HD auto first() const { return meet.side(couple.body[0], couple.body[1], 1.0); }
    TREAD_HD auto second() const { return meet.side(couple.body[1], couple.body[0], -1.0); }

    TREAD_HD NodeInField operator()(std::int32_t node) const
    {
        const int owner = node < 0 ? 1 : 0;
        return in_field(meet.side(couple.body[owner], couple.body[1 - owner], 1.0 - 2.0 * owner),
                        owner == 1 ? ~node : node);
    }
};

/// Narrow phase by distance fields; the alternative MeetByRays uses rays.
struct MeetByDistance
{
    /// Returns a side; both bodies have nodes, each with half its area.
    TREAD_HD Side<BodyField> side(const Instance& owner, const Instance& other, double sign) const
    {
        return {owner, {other}, 0.5, sign};
    }

    /// Second derivative d2/dx2 of a node's energy divided by area and p'(d): |gradient|^2, which is 1 for a distance.
    TREAD_HD static double stiffening(const NodeInField&) { return 1; }
};

} // namespace tread::dem
