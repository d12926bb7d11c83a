#pragma once

#include <cmath>
#include <cstdint>

#include "backend/vector.hpp"
#include "kernels/dem/contact/spring_kern.hpp"

// Contact law of a sand point and a rigid body. The force on the point acts at its position x_p; friction acts on the
// body at its surface, x_p - phi n, against the surface velocity there, so that a wheel rolls on its own radius
// whatever the size of the points. The normal force acts along the line between the two positions and has no couple;
// the couple of friction, phi n x F_t, acts on the body and not on the sand.
namespace tread::contact
{

/// Radius of the sphere that represents a point. Both rules use the initial volume: a radius that followed the current
/// volume would do work by itself.
enum class RadiusRule : std::int32_t
{
    sphere,      ///< (3 V0 / 4 pi)^(1/3), the paper's Eq. 11 with eta = 1
    semi_domain, ///< 0.5 V0^(1/3), the paper's section 2.3.2
};

TREAD_HD double point_radius(double initial_volume, RadiusRule rule)
{
    constexpr double sphere_factor = 0.75 / 3.14159265358979323846;
    return rule == RadiusRule::sphere ? std::cbrt(sphere_factor * initial_volume) : 0.5 * std::cbrt(initial_volume);
}

/// Record of one contact between substeps; all zero while the pair is separated.
struct Tangential
{
    Vec3<double> force;     ///< N, on the point
    Vec3<double> normal;    ///< unit, out of the body, at the last update
    double       stiffness; ///< N/m, k_t at that update
};

TREAD_HD Tangential no_tangential() { return {Vec3<double>::Zero(), Vec3<double>::Zero(), 0.0}; }

/// Whether a record has a normal, that is, whether the pair was in contact.
TREAD_HD bool is_known(const Vec3<double>& normal) { return normal.squaredNorm() > 0; }

/// Contact parameters of one point-body pair.
struct PairConstants
{
    double effective_young;  ///< Pa, E*
    double effective_shear;  ///< Pa, G*
    double friction;         ///< Coulomb coefficient
    double hertz_factor;     ///< 1, or 1/sqrt(2) for the paper's Eq. 7
    double point_radius;     ///< m, r_p
    double effective_radius; ///< m, R*
};

/// Returns R* with 1/R* = 1/r_p + 1/R_body; an infinite R_body is a plane.
TREAD_HD double effective_radius(double point_radius, double body_radius)
{
    return 1.0 / (1.0 / point_radius + 1.0 / body_radius);
}

/// Position and velocity of the point relative to the body.
struct Approach
{
    double       distance; ///< m, phi(x_p), negative inside the body
    Vec3<double> gradient; ///< grad phi in the world frame, not normalised
    Vec3<double> velocity; ///< m/s, of the point relative to the body's material at its surface, x_p - phi n
};

/// Returns the vector from the body's surface to the point, m: phi n.
TREAD_HD Vec3<double> stand_off(double distance, const Vec3<double>& gradient)
{
    const double length = gradient.norm();
    return length > 0 ? Vec3<double>((distance / length) * gradient) : Vec3<double>(0.0, 0.0, 0.0);
}

/// Result of the law for one contact in one substep; all zero, including the gradient, while the pair is separated.
struct Response
{
    Vec3<double> force;           ///< N, on the point; the body gets the exact opposite
    Vec3<double> couple;          ///< N m, on the body, in addition to its force at x_p: friction acts at the surface
    double       overlap;         ///< m, d = r_p - phi
    double       stiffness;       ///< N/m, k_n = dF/dd
    double       gradient_length; ///< of the SDF; 1 on a smooth face, small on a medial axis
    double       energy;          ///< J, elastic: normal + tangential
    double       dissipated;      ///< J, dissipated by friction in this substep, never negative
};

TREAD_HD Response no_response() { return {Vec3<double>::Zero(), Vec3<double>::Zero(), 0.0, 0.0, 0.0, 0.0, 0.0}; }

/// Advances Mindlin's tangential force incrementally (the paper's Eq. 9a): dF_t = -k_t v_t dt, k_t = 8 G* sqrt(R* d).
/// It is rescaled by k_t,new/k_t,old on unloading, otherwise a closed cycle creates energy (docs/theory.md#friction),
/// and capped at mu |F_n|. Returns the dissipated energy, never negative: by the change of stiffness, and by slip = cap
/// times slip distance.
TREAD_HD double update_tangential(Tangential& tangential, const Vec3<double>& normal, const Vec3<double>& velocity,
                                  double stiffness, double cap, double dt)
{
    double       lost  = dem::spring_energy(tangential.force.squaredNorm(), tangential.stiffness);
    Vec3<double> force = dem::turn_with_normal(tangential.force, tangential.normal, normal);
    if (stiffness < tangential.stiffness) { force *= stiffness / tangential.stiffness; }
    lost -= dem::spring_energy(force.squaredNorm(), stiffness);

    force -= stiffness * dt * (velocity - normal * normal.dot(velocity));
    const double length = force.norm();
    if (length > cap)
    {
        force *= cap / length;
        lost += cap * (length - cap) / stiffness;
    }
    tangential = {force, normal, stiffness};
    return lost;
}

/// Computes the response: Hertz (Eq. 14), F_n = 4/3 E* sqrt(R*) d^1.5 grad phi, with an un-normalised gradient, so that
/// force and energy derive from one potential 8/15 E* sqrt(R*) d^2.5; plus the tangential force. Updates the history.
TREAD_HD Response point_body_response(const PairConstants& pair, const Approach& approach, Tangential& tangential,
                                      double dt)
{
    const double overlap = pair.point_radius - approach.distance;
    if (!(overlap > 0))
    {
        const double lost = dem::spring_energy(tangential.force.squaredNorm(), tangential.stiffness);
        tangential        = no_tangential();
        Response apart    = no_response();
        apart.dissipated  = lost;
        return apart;
    }
    const double patch_radius = std::sqrt(pair.effective_radius * overlap);
    const double stiffness    = 2.0 * pair.hertz_factor * pair.effective_young * patch_radius;
    const double normal_force = 2.0 / 3.0 * stiffness * overlap;

    Response response;
    response.force           = normal_force * approach.gradient;
    response.couple          = Vec3<double>::Zero();
    response.overlap         = overlap;
    response.stiffness       = stiffness;
    response.gradient_length = approach.gradient.norm();
    response.energy          = 4.0 / 15.0 * stiffness * overlap * overlap;
    response.dissipated      = 0.0;
    if (!(response.gradient_length > 0)) { return response; }
    const Vec3<double> normal = approach.gradient / response.gradient_length;
    if (pair.friction > 0)
    {
        response.dissipated =
            update_tangential(tangential, normal, approach.velocity, 8.0 * pair.effective_shear * patch_radius,
                              pair.friction * normal_force * response.gradient_length, dt);
        response.force += tangential.force;
        response.couple = stand_off(approach.distance, approach.gradient).cross(tangential.force);
        response.energy += dem::spring_energy(tangential.force.squaredNorm(), tangential.stiffness);
    }
    else { tangential.normal = normal; }
    return response;
}

} // namespace tread::contact
