#pragma once

#include "kernels/dem/integrate.hpp"
#include "kernels/dem/integrate_kern.hpp"

// The launches of integrate.hpp, the same on both backends; integrate.cpp and integrate.cu bring in for_each.
namespace tread::dem::integration
{

struct Clear
{
    BodiesView bodies;

    TREAD_HD void operator()(std::int64_t b) const
    {
        bodies.force[b]     = Vec3<double>::Zero();
        bodies.torque[b]    = Vec3<double>::Zero();
        bodies.stiffness[b] = 0;
        if (bodies.sand_force == nullptr) { return; }
        bodies.sand_force[b]  = Vec3<double>::Zero();
        bodies.sand_torque[b] = Vec3<double>::Zero();
    }
};

struct Free
{
    BodiesView   bodies;
    BodyTotal*   totals;
    Vec3<double> gravity;
    double       dt;

    TREAD_HD void operator()(std::int64_t b) const
    {
        integrate_translation(bodies, b, gravity, NoDamping{}, dt, totals[b]);
        integrate_rotation(bodies, b, NoDamping{}, dt, totals[b]);
    }
};

struct Damped
{
    BodiesView   bodies;
    BodyTotal*   totals;
    Vec3<double> gravity;
    double       alpha;
    double       dt;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const LocalDamping damping{bodies.damped[b] != 0 ? alpha : 0.0};
        integrate_translation(bodies, b, gravity, damping, dt, totals[b]);
        integrate_rotation(bodies, b, damping, dt, totals[b]);
    }
};

} // namespace tread::dem::integration
