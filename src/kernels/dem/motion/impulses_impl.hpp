#pragma once

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
