#pragma once

#include <algorithm>

#include "kernels/dem/contact/sdf_kern.hpp"

// Contact in the middle of a thin wall, such as a grouser that is thinner than a point's sphere. There the nearest
// surface is not unique: its normal vanishes or reverses, and a point would be pushed out on the far side. It is pushed
// back to the side at which it came in instead, along the last normal of its contact.
namespace tread::contact
{

/// Component of grad phi along the last normal, below which a point inside a body has another side nearest, or none.
/// It is at least 0.7 where a point passes gradually from one face of a right-angled edge to the other.
constexpr double same_side = 0.5;

constexpr double deepest_entered = 4.0; ///< r_p, largest distance to the entered side; beyond it the nearest counts

/// Returns the distance and normal with respect to the side where a point entered the body: the exit is searched along
/// `side` (unit, out of the body) by steps of the distance itself (sphere tracing, J. C. Hart, The Visual Computer 12,
/// 1996), but not shorter than a twentieth of r_p, since interpolated distances can be flat. `nearest`: sample at the
/// point; sdf(offset): sample at an offset from it (m). Returns `nearest` if there is no exit within deepest_entered.
template<class Sdf>
TREAD_HD dem::SdfSample entered_side(const dem::SdfSample& nearest, const Vec3<double>& side, double point_radius,
                                     const Sdf& sdf)
{
    const double shortest = 0.05 * point_radius;
    double       depth    = 0;
    double       inside   = -nearest.distance;
    while (depth < deepest_entered * point_radius)
    {
        const double step = std::max(inside, shortest);
        const double next = -sdf(Vec3<double>((depth + step) * side)).distance;
        if (next <= 0) { return {-(depth + step * inside / (inside - next)), side}; }
        depth += step;
        inside = next;
    }
    return nearest;
}

} // namespace tread::contact
