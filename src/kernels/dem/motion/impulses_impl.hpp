#pragma once

#include "backend/instantiate.hpp"
#include "kernels/dem/motion/impulses.hpp"

// Steps of impulses.hpp, for both backends; impulses.cpp and impulses.cu provide for_each.
namespace tread::dem::impulse_steps
{

struct Measure
{
    BodiesView    bodies;
    const double* bounding_radii;
    Vec3<double>  gravity;
    BodyActivity* activity;

    TREAD_HD void operator()(std::int64_t b) const
    {
        if (!bodies.is_owned(b))
        {
            activity[b] = {};
            return;
        }
        activity[b].speed        = bodies.velocity[b].norm() + bodies.angular_velocity[b].norm() * bounding_radii[b];
        activity[b].weight_power = bodies.mass[b] * gravity.dot(bodies.velocity[b]);
        const bool   fixed       = bodies.is_fixed(b) || (bodies.locked[b] & prescribed) != 0;
        const double share       = bodies.acting_weight(b, bodies.locked[b]);
        activity[b].net_force    = fixed ? 0.0 : (bodies.force[b] + share * bodies.mass[b] * gravity).norm();
    }
};

} // namespace tread::dem::impulse_steps

namespace tread::dem
{

template<class Exec>
void measure_activity(const Exec& exec, const BodiesView& bodies, const double* bounding_radii,
                      const Vec3<double>& gravity, BodyActivity* activity)
{
    for_each(exec, "measure activity", bodies.count, impulse_steps::Measure{bodies, bounding_radii, gravity, activity});
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void measure_activity(const Exec&, const BodiesView&, const double*, const Vec3<double>&, BodyActivity*)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
