#pragma once

#include "backend/atomic.hpp"
#include "kernels/dem/pairs/displacement_limit.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"

namespace tread::dem
{

/// Upper bound of the way (m) of any point of a body since it was at `position`, in `orientation`. A rotation by the
/// angle t moves no point further than 2 sin(t/2) times the bounding radius (m); the norm of a quaternion's vector part
/// is sin(t/2).
TREAD_HD double displacement_since(const BodiesView& bodies, std::int64_t b, const Vec3<double>& position,
                                   const Quat& orientation, double radius)
{
    const double turned = (bodies.orientation[b] * orientation.conjugate()).vec().norm();
    return (bodies.position[b] - position).norm() + 2.0 * turned * radius;
}

/// The same since the body's pairs were found, `age` (s) ago, from where it has drifted to.
TREAD_HD double displacement_since(const BodiesView& bodies, std::int64_t b, const ListedPlaces& listed, double age,
                                   double radius)
{
    Vec3<double> place = listed.position[b];
    if (listed.allowed.drift != nullptr) { place += age * listed.allowed.drift[b]; }
    return displacement_since(bodies, b, place, listed.orientation[b], radius);
}

/// Upper bound of the way (m) of any point of a body until its pairs are found again; 0 if there is no list.
TREAD_HD double way_to_come(const BodiesView& bodies, std::int64_t b, const ListedPlaces& listed, double radius)
{
    if (listed.allowed.displacement == nullptr) { return 0; }
    return listed.allowed.displacement[b] + displacement_since(bodies, b, listed, listed.age, radius) +
           listed.allowed.drift_of(b);
}

/// Upper bound of the displacement (m) of a body of this bounding radius (m) within the coming steps, of `ahead` (s)
/// each, plus a reserve, since a body at rest may be set in motion.
TREAD_HD double displacement_ahead(const BodiesView& bodies, std::int64_t b, const AllowedMotion& allowed,
                                   double radius, double ahead)
{
    Vec3<double> velocity = bodies.velocity[b];
    if (allowed.drift != nullptr) { velocity -= allowed.drift[b]; }
    return steps_ahead * ahead * (velocity.norm() + rim_speed(bodies, b, radius)) + rest_reserve * radius;
}

inline constexpr std::int64_t batches_ahead = 2; ///< batches of substeps that a look covers: it applies one later

/// Looks ahead after the present substep, if it is the last of a batch and nobody has found the list to expire yet.
TREAD_HD void check_displacement_ahead(const DisplacementLimit& limit, const BodiesView& bodies, std::int64_t b)
{
    if (limit.listed.allowed.displacement == nullptr) { return; }
    const std::int32_t now = limit.repeated != nullptr ? load_together(limit.repeated) : limit.substep;
    if (now % limit.batch != 0 || now >= limit.substeps || load_together(limit.last) != 0) { return; }
    const std::int64_t left = limit.substeps - now, covered = batches_ahead * limit.batch;
    const double       ahead = limit.dt * static_cast<double>(covered < left ? covered : left),
                 radius = bounding_radius(bodies, limit.templates, b), age = limit.listed.age + limit.dt * now,
                 moved = displacement_since(bodies, b, limit.listed, age, radius);
    if (!((moved + displacement_ahead(bodies, b, limit.listed.allowed, radius, ahead)) /
              limit.listed.allowed.displacement[b] <=
          1))
    {
        store_together(limit.last, now + limit.batch);
    }
}

} // namespace tread::dem
