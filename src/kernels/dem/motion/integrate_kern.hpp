#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/dem/bodies.hpp"
#include "kernels/dem/contact/contact_body.hpp"
#include "kernels/dem/motion/outside.hpp"
#include "kernels/dem/motion/totals.hpp"
#include "kernels/local_damping_kern.hpp"

// One substep of one rigid body. Translation: symplectic Euler. Rotation: the world-frame angular momentum L is
// advanced by the torque exactly, and the orientation by the exponential map of the angular velocity at mid-step. A
// torque-free body then conserves L to rounding and its energy to third order (explicit midpoint of R' = [omega(R, L)]
// R).
namespace tread::dem
{

/// No local damping.
struct NoDamping
{
    static constexpr bool acts = false;

    TREAD_HD double operator()(double, double) const { return 0.0; }
};

/// Local damping of the settling phases.
struct LocalDamping
{
    static constexpr bool acts = true;

    double alpha; ///< 0 to 1

    TREAD_HD double operator()(double force, double velocity) const { return local_damping(alpha, force, velocity); }
};

template<class Damping>
TREAD_HD Vec3<double> damping_of(const Damping& damping, const Vec3<double>& force, const Vec3<double>& velocity)
{
    return {damping(force[0], velocity[0]), damping(force[1], velocity[1]), damping(force[2], velocity[2])};
}

/// Contains cos h and sin(h)/h.
struct Turn
{
    double cosine;
    double sine_over;
};

/// Computes a Turn from h^2. Rotations per substep are small: five terms are then exact to rounding (h^10 / 10! <
/// 3e-22), without the latency of a root, sine or division on a GPU.
TREAD_HD Turn turn_of(double square)
{
    constexpr double little = 1e-3; // limit of h^2
    if (square < little)
    {
        const auto series = [square](double a, double b, double c, double d)
        { return 1.0 - square * (a - square * (b - square * (c - square * d))); };
        return {series(1.0 / 2, 1.0 / 24, 1.0 / 720, 1.0 / 40320),
                series(1.0 / 6, 1.0 / 120, 1.0 / 5040, 1.0 / 362880)};
    }
    const double h = std::sqrt(square);
    return {std::cos(h), std::sin(h) / h};
}

/// Exponential map of a rotation vector (rad).
TREAD_HD Quat rotation_by(const Vec3<double>& vector)
{
    const Turn         half = turn_of(0.25 * vector.squaredNorm());
    const Vec3<double> axis = 0.5 * half.sine_over * vector;
    return {half.cosine, axis[0], axis[1], axis[2]};
}

/// Normalises a quaternion whose error is only rounding: one Newton step for 1/|q|.
TREAD_HD Quat made_unit(const Quat& q) { return Quat((1.5 - 0.5 * q.squaredNorm()) * q.coeffs()); }

TREAD_HD bool is_locked(std::uint32_t locked, LockedFreedom first, int component)
{
    return (locked & (static_cast<std::uint32_t>(first) << component)) != 0;
}

inline constexpr std::uint32_t locked_rotation = lock_roll | lock_pitch | lock_yaw;

/// Returns omega at orientation `rotation` such that the free components of J omega are those of `momentum` and the
/// locked components of omega are those of `present`: J = R I R^T. The constraint torque acts on locked components
/// only.
TREAD_HD Vec3<double> angular_velocity_of(const Mat3<double>& rotation, const Mat3<double>& inertia,
                                          const Mat3<double>& inverse_inertia, const Vec3<double>& momentum,
                                          const Vec3<double>& present, std::uint32_t locked)
{
    if ((locked & locked_rotation) == 0) { return rotation * (inverse_inertia * (rotation.transpose() * momentum)); }
    if ((locked & locked_rotation) == locked_rotation) { return present; }
    Mat3<double> matrix = rotation * inertia * rotation.transpose();
    Vec3<double> wanted = momentum;
    for (int c = 0; c < 3; ++c)
    {
        if (!is_locked(locked, lock_roll, c)) { continue; }
        matrix.row(c) = Vec3<double>::Unit(c).transpose();
        wanted[c]     = present[c];
    }
    return matrix.inverse() * wanted;
}

/// Motion and inertia of a body. It is read before the sums over its contacts, so that the loads overlap with them.
struct BodyMotion
{
    Vec3<double>  position;
    Quat          orientation;
    Vec3<double>  velocity;
    Vec3<double>  angular_velocity;
    double        mass;
    Sym3<double>  inertia;
    std::uint32_t locked;
};

/// Reads the motion of body b; `shown` must agree with `bodies`.
TREAD_HD BodyMotion motion_of(const BodiesView& bodies, std::int64_t b, const ContactBody& shown)
{
    return {shown.position, shown.orientation, shown.velocity,  shown.spin,
            bodies.mass[b], bodies.inertia[b], bodies.locked[b]};
}

TREAD_HD void store_motion(const BodiesView& bodies, std::int64_t b, const BodyMotion& motion)
{
    bodies.position[b]         = motion.position;
    bodies.orientation[b]      = motion.orientation;
    bodies.velocity[b]         = motion.velocity;
    bodies.angular_velocity[b] = motion.angular_velocity;
}

/// Moves a body by dt (s) under its contact force, gravity (m/s2) and damping. Adds to its row of totals only nonzero
/// terms, because a row is as large as the rest of a body. A locked component keeps its velocity whatever the forces.
/// Returns the velocity at mid-step.
template<class Damping>
TREAD_HD Vec3<double> integrate_translation(BodyMotion& body, const Vec3<double>& force, const Vec3<double>& gravity,
                                            const Damping& damping, double dt, BodyTotal& total)
{
    const Vec3<double> before   = body.velocity;
    const Vec3<double> acting   = force + body.mass * gravity;
    const Vec3<double> damped   = damping_of(damping, acting, before);
    const double       response = dt / body.mass;
    Vec3<double>       after = before, holding = Vec3<double>::Zero();
    for (int c = 0; c < 3; ++c)
    {
        if (is_locked(body.locked, lock_x, c)) { holding[c] = -dt * (acting[c] + damped[c]); }
        else { after[c] += response * (acting[c] + damped[c]); }
    }
    Vec3<double> mean = 0.5 * (before + after);
    if constexpr (Damping::acts)
    {
        total.damping_impulse += dt * damped;
        total.damping -= dt * damped.dot(mean);
    }
    if (body.locked != 0)
    {
        total.holding_impulse += holding;
        total.holding_work += holding.dot(mean);
    }
    body.velocity = after;
    body.position += dt * after;
    return mean;
}

/// Rotates a body likewise under its torque; returns the angular velocity over the step.
template<class Damping>
TREAD_HD Vec3<double> integrate_rotation(BodyMotion& body, const Vec3<double>& torque, const Damping& damping,
                                         double dt, BodyTotal& total)
{
    const Mat3<double>  inertia = full(body.inertia), inverse = inertia.inverse();
    const std::uint32_t locked = body.locked;
    const Quat          start  = body.orientation;
    const Vec3<double>  before = body.angular_velocity;
    const Vec3<double>  damped = damping_of(damping, torque, before);

    const Mat3<double> at_start = start.toRotationMatrix();
    const Vec3<double> momentum = at_start * (inertia * (at_start.transpose() * before)) + dt * (torque + damped);
    const Vec3<double> kicked   = angular_velocity_of(at_start, inertia, inverse, momentum, before, locked);
    const Quat         half     = rotation_by(0.5 * dt * kicked) * start;
    const Vec3<double> middle =
        angular_velocity_of(half.toRotationMatrix(), inertia, inverse, momentum, before, locked);
    const Quat         end    = made_unit(rotation_by(dt * middle) * start);
    const Mat3<double> at_end = end.toRotationMatrix();
    const Vec3<double> after  = angular_velocity_of(at_end, inertia, inverse, momentum, before, locked);

    Vec3<double> mean = 0.5 * (before + kicked);
    if constexpr (Damping::acts) { total.damping -= dt * damped.dot(mean); }
    if ((locked & locked_rotation) != 0)
    {
        const Vec3<double> reached = at_end * (inertia * (at_end.transpose() * after));
        total.holding_work += (reached - momentum).dot(0.5 * (kicked + after));
    }
    body.orientation      = end;
    body.angular_velocity = after;
    return mean;
}

/// Mean velocities of a body over a step.
struct MeanMotion
{
    Vec3<double> velocity;         ///< m/s
    Vec3<double> angular_velocity; ///< rad/s
};

/// Integrates translation and rotation over a step.
template<class Damping>
TREAD_HD MeanMotion integrate_body(BodyMotion& body, const ContactWrench& contact, const Vec3<double>& gravity,
                                   const Damping& damping, double dt, BodyTotal& total)
{
    const Vec3<double> velocity = integrate_translation(body, contact.force, gravity, damping, dt, total);
    return {velocity, integrate_rotation(body, contact.torque, damping, dt, total)};
}

} // namespace tread::dem
