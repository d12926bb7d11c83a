#pragma once

#include <cmath>

#include "kernels/dem/contact/body_contact_kern.hpp"
#include "kernels/dem/contact/ray_kern.hpp"
#include "kernels/dem/pairs/pairs.hpp"

// The narrow phase by rays, after the ray-tracing DEM of the paper's rocks (Zhao and Zhao 2023): each surface node
// looks along its inward normal for the place where it leaves the other body. The traction law is that of the distance
// fields.
namespace tread::dem
{

/// A body as rays of the other one's nodes meet it.
struct RayField
{
    BodyField      solid; ///< tells which clusters of nodes are near
    const RayView* own;   ///< of the body that the nodes are of
    const RayView* other;

    TREAD_HD double    distance_from_centre(const Vec3<double>& y) const { return solid.distance_from_centre(y); }
    TREAD_HD double    reach() const { return solid.reach(); }
    TREAD_HD double    bound(double r) const { return solid.bound(r); }
    TREAD_HD SdfSample operator()(const Vec3<double>& y) const { return solid(y); }

    /// Rays know the surface itself, not the interpolated one.
    TREAD_HD double bound_of_node(double way) const
    {
        const Instance& body = solid.body;
        return way + sdf_uncertainty(*body.shape, body.scale, way);
    }
};

/// The node is inside if the first triangle that its ray meets is one where the ray leaves. The ray, its length d
/// included, turns with the node's body: the gradient of d is n/(n . m), with n the triangle's normal, m the ray's
/// direction, and the force acts where the ray leaves. So the force comes from a potential, but where the ray jumps to
/// another part of the surface, and where it leaves at a slant: least_cosine.
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

/// Two bodies see each other by rays.
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

/// Calls act(meet) with the way in which the scene's bodies see each other.
template<class Act>
void by_narrow_phase(const BodyLaw& law, Act act)
{
    if (law.rays == nullptr) { act(MeetByDistance{}); }
    else { act(MeetByRays{law.templates, law.rays}); }
}

} // namespace tread::dem
