#pragma once

#include <cmath>
#include <cstdint>

#include "backend/vector.hpp"

// Rays against the triangles of a template, at scale 1 in the body frame.
namespace tread::dem
{

/// A box about triangles. Nodes stand depth first, so that a walk needs no stack: into a box goes to the node that
/// follows, past it to `next`.
struct RayBox
{
    float        low[3];
    float        high[3];
    std::int32_t next; ///< the first node that is not inside this one
    std::int32_t leaf; ///< 8 first + count of its triangles; 0 = it holds boxes
};

struct RayTriangle
{
    Vec3<double> corner;
    Vec3<double> side_1; ///< from `corner` to the next
    Vec3<double> side_2; ///< to the one after; side_1 x side_2 points outwards
};

/// What the narrow phase by rays needs of a template, beside its TemplateView.
struct RayView
{
    const RayBox*       boxes;
    std::int32_t        box_count;
    const RayTriangle*  triangles;
    const Vec3<double>* inward; ///< of each surface node, unit
    const double*       length; ///< m, of each node's ray: half of its way through its own body
};

struct RayHit
{
    double       length;   ///< m, from the origin
    std::int32_t triangle; ///< -1 = none
    Vec3<double> normal;   ///< unit, outwards; of a hit alone
    double       cosine;   ///< of direction and normal: positive where the ray leaves the body
};

TREAD_HD bool ray_meets(const RayBox& box, const Vec3<double>& origin, const Vec3<double>& inverse, double length)
{
    double first = 0, last = length;
    for (int c = 0; c < 3; ++c)
    {
        const double low  = (static_cast<double>(box.low[c]) - origin[c]) * inverse[c];
        const double high = (static_cast<double>(box.high[c]) - origin[c]) * inverse[c];
        first             = std::fmax(first, std::fmin(low, high));
        last              = std::fmin(last, std::fmax(low, high));
    }
    return first <= last;
}

/// How far along the ray it meets the triangle; `beyond` if not before that. By the ratios of volumes of Moeller and
/// Trumbore 1997 (J. Graphics Tools 2:21). A triangle reaches a billionth beyond its sides, so that no ray slips
/// through between two.
TREAD_HD double ray_length(const RayTriangle& triangle, const Vec3<double>& origin, const Vec3<double>& direction,
                           double beyond)
{
    constexpr double   rim   = 1e-9;
    const Vec3<double> p     = direction.cross(triangle.side_2);
    const double       scale = 1.0 / triangle.side_1.dot(p);
    const Vec3<double> from  = origin - triangle.corner;
    const double       u     = scale * from.dot(p);
    if (!(u >= -rim && u <= 1 + rim)) { return beyond; }
    const Vec3<double> q = from.cross(triangle.side_1);
    const double       v = scale * direction.dot(q);
    if (!(v >= -rim && u + v <= 1 + rim)) { return beyond; }
    const double length = scale * triangle.side_2.dot(q);
    return length > 0 && length < beyond ? length : beyond;
}

/// The first triangle that a ray meets within `length`. direction: unit.
TREAD_HD RayHit first_hit(const RayView& body, const Vec3<double>& origin, const Vec3<double>& direction, double length)
{
    constexpr double parallel = 1e300; // finite, for 0 times infinity is no place
    Vec3<double>     inverse;
    for (int c = 0; c < 3; ++c) { inverse[c] = direction[c] == 0 ? parallel : 1.0 / direction[c]; }

    RayHit hit{length, -1, Vec3<double>::Zero(), 0};
    for (std::int32_t at = 0; at < body.box_count;)
    {
        const RayBox box = body.boxes[at];
        if (!ray_meets(box, origin, inverse, hit.length))
        {
            at = box.next;
            continue;
        }
        const std::int32_t first = box.leaf >> 3, last = first + (box.leaf & 7);
        for (std::int32_t t = first; t < last; ++t)
        {
            const double found = ray_length(body.triangles[t], origin, direction, hit.length);
            if (found < hit.length)
            {
                hit.length   = found;
                hit.triangle = t;
            }
        }
        ++at;
    }
    if (hit.triangle < 0) { return hit; }
    const RayTriangle& met = body.triangles[hit.triangle];
    hit.normal             = met.side_1.cross(met.side_2).normalized();
    hit.cosine             = hit.normal.dot(direction);
    return hit;
}

} // namespace tread::dem
