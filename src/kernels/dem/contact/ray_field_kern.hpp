#pragma once

#include <cmath>

#include "kernels/dem/contact/body_contact_kern.hpp"
#include "kernels/dem/contact/ray_kern.hpp"
#include "kernels/dem/pairs/pairs.hpp"

// Narrow phase by rays, after the ray-tracing DEM of the paper's rocks (Zhao and Zhao 2023): from each surface node a
// ray along its inward normal is traced to where it leaves the other body. The traction law is that of the distance
// fields.
namespace tread::dem
{

/// A body as seen by the rays of the other body's nodes.
struct RayField
{
    BodyField      solid; ///< tells which nodes are near
    const RayView* own;   ///< of the body that owns the nodes
    const RayView* other;

    /// Upper bound, m, of the distance field at nodes that cross the true surface, which rays use, when they move by at
    /// most `way`: includes the interpolation error of the field.
    TREAD_HD double bound_of_node(double way) const
    {
        const Instance& body = solid.body;
        return way + sdf_uncertainty(*body.shape, body.scale, way);
    }
};

/// Evaluates a node: it is inside if the first triangle that its ray meets is one where the ray leaves the body. The
/// ray, of length d, rotates with the node's body: the gradient of d is n/(n . m), with n the triangle's normal and m
/// the ray's direction, and the force acts where the ray leaves. The force therefore derives from a potential, except
/// where the ray jumps to another part of the surface and where it leaves at a grazing angle (least_cosine).
TREAD_HD NodeInField in_field(const Side<RayField>& side, std::int32_t i)
{
    constexpr double   least_cosine = 0.5; // a node's force is at most twice its area times the traction
    const Instance&    owner        = side.owner;
    const Instance&    body         = side.field.solid.body;
    const RayView&     own          = *side.field.own;
    const Vec3<double> y            = side.node(i);
    const Vec3<double> along        = owner.rotation * own.inward[i];
    const Vec3<double> origin       = body.rotation.transpose() * (y - body.centre) * body.inverse_scale;
    const Vec3<double> direction    = body.rotation.transpose() * along;
    const RayHit       hit =
        first_hit(*side.field.other, origin, direction, own.length[i] * owner.scale * body.inverse_scale);
    if (!(hit.cosine > 0)) { return {y, Vec3<double>::Zero(), 0, 0, side.sign}; }
    const double depth = hit.length * body.scale;
    return {y + depth * along, body.rotation * hit.normal / std::fmax(hit.cosine, least_cosine), depth, side.weight(i),
            side.sign};
}

/// Narrow phase of two bodies by rays.
struct MeetByRays
{
    const TemplateView* templates;
    const RayView*      rays; ///< of the templates

    TREAD_HD Side<RayField> side(const Instance& owner, const Instance& other, double sign) const
    {
        return {owner, {{other}, rays + (owner.shape - templates), rays + (other.shape - templates)}, 0.5, sign};
    }

    TREAD_HD static double stiffening(const NodeInField& node) { return node.gradient.squaredNorm(); }
};

/// Calls act(meet) with the scene's narrow phase.
template<class Act>
void by_narrow_phase(const BodyLaw& law, Act act)
{
    if (law.rays == nullptr) { act(MeetByDistance{}); }
    else { act(MeetByRays{law.templates, law.rays}); }
}

} // namespace tread::dem
