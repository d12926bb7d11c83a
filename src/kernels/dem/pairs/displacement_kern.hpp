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

/// Ends the batch of substeps if the body has moved too far, or to no finite position.
TREAD_HD void check_displacement(const DisplacementLimit& limit, const BodiesView& bodies, std::int64_t b)
{
    if (limit.allowed == nullptr) { return; }
    const double moved = displacement_since(bodies, b, limit.position[b], limit.orientation[b],
                                            bounding_radius(bodies, limit.templates, b));
    if (!(moved <= limit.allowed[b])) { store_together(limit.reached, limit.substep); }
}

} // namespace tread::dem
