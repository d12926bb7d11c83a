#pragma once

#include <cmath>
#include <cstdint>

#include "backend/vector.hpp"

// Intersection of rays with the triangles of a template, at scale 1 in the body frame.
namespace tread::dem
{

/// Bounding box of triangles. Boxes are stored depth first, so that traversal needs no stack: a hit continues with the
/// following box, a miss with `next`.
struct RayBox
{
    float        low[3];
    float        high[3];
    std::int32_t next; ///< the first box that is not inside this one
    std::int32_t leaf; ///< 8 first + count of its triangles; 0 = inner box
};

struct RayTriangle
{
    Vec3<double> corner;
    Vec3<double> side_1; ///< from `corner` to the next corner
    Vec3<double> side_2; ///< from `corner` to the one after next; side_1 x side_2 points outwards
};

/// Data of a template for the narrow phase by rays, in addition to its TemplateView.
struct RayView
{
    const RayBox*       boxes;
    std::int32_t        box_count;
    const RayTriangle*  triangles;
    const Vec3<double>* inward; ///< of each surface node, unit inward normal
    const double*       length; ///< m, length of each node's ray: half the thickness of its own body there
};

struct RayHit
{
    double       length;   ///< m, from the origin
    std::int32_t triangle; ///< -1 = none
    Vec3<double> normal;   ///< unit, outwards; valid only for a hit
    double       cosine;   ///< between direction and normal: positive where the ray leaves the body
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

/// Returns the distance along the ray to the triangle, or `beyond` if there is no hit before that. Ratios of volumes
/// after Moeller and Trumbore 1997 (J. Graphics Tools 2:21). Triangles are extended by a billionth beyond their sides,
/// so that no ray passes between two.
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

/// Returns the first triangle that a ray meets within `length`. direction: unit.
TREAD_HD RayHit first_hit(const RayView& body, const Vec3<double>& origin, const Vec3<double>& direction, double length)
{
    constexpr double parallel = 1e300; // finite, because 0 times infinity is NaN
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
