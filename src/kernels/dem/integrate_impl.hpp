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

    /// Moves `body`, which is body b.
    TREAD_HD void operator()(std::int64_t b, BodyMotion& body, const Wrench& contact) const
    {
        integrate_body(bodies, b, body, contact, gravity, NoDamping{}, dt, totals[b]);
    }
};

struct Damped
{
    BodiesView   bodies;
    BodyTotal*   totals;
    Vec3<double> gravity;
    double       alpha;
    double       dt;

    TREAD_HD void operator()(std::int64_t b, BodyMotion& body, const Wrench& contact) const
    {
        const LocalDamping damping{bodies.damped[b] != 0 ? alpha : 0.0};
        integrate_body(bodies, b, body, contact, gravity, damping, dt, totals[b]);
    }
};

/// Under the wrenches that the bodies have.
template<class Integrate>
struct InPlace
{
    Integrate integrate;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const BodiesView& bodies = integrate.bodies;
        BodyMotion        body   = motion_of(bodies, b);
        integrate(b, body, {bodies.force[b], bodies.torque[b]});
        store_motion(bodies, b, body);
    }
};

template<class Integrate>
InPlace(Integrate) -> InPlace<Integrate>;

} // namespace tread::dem::integration
