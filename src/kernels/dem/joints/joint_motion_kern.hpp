#pragma once

#include "kernels/dem/joints/joint_rows.hpp"
#include "kernels/dem/motion/prescribed_kern.hpp"

// Motion of a jointed body in a substep without its joints, and how it yields to their impulses.
namespace tread::dem::joint_solve
{

/// Inverse of the inertia for torques in directions that are not locked.
TREAD_HD Mat3<double> response_of(const Mat3<double>& rotation, const Mat3<double>& inverse_inertia,
                                  const Mat3<double>& inertia, std::uint32_t locked)
{
    if ((locked & locked_rotation) == 0) { return rotation * inverse_inertia * rotation.transpose(); }
    if ((locked & locked_rotation) == locked_rotation) { return Mat3<double>::Zero(); }
    Mat3<double> matrix = rotation * inertia * rotation.transpose();
    for (int c = 0; c < 3; ++c)
    {
        if (!is_locked(locked, lock_roll, c)) { continue; }
        matrix.row(c) = Vec3<double>::Unit(c).transpose();
        matrix.col(c) = Vec3<double>::Unit(c);
    }
    Mat3<double> response = matrix.inverse();
    for (int c = 0; c < 3; ++c)
    {
        if (!is_locked(locked, lock_roll, c)) { continue; }
        response.row(c).setZero();
        response.col(c).setZero();
    }
    return response;
}

/// Velocity of a body after a substep of dt (s) without joints, as integrate_body finds it without damping.
TREAD_HD JointLink free_motion(const BodiesView& bodies, std::int64_t b, const ContactWrench& contact,
                               const Vec3<double>& gravity, double dt)
{
    const std::uint32_t locked  = bodies.locked[b];
    const Mat3<double>  inertia = full(bodies.inertia[b]), inverse = inertia.inverse();
    const Quat          start    = bodies.orientation[b];
    const Mat3<double>  rotation = start.toRotationMatrix();
    const Vec3<double>  before   = bodies.angular_velocity[b];
    const Vec3<double>  momentum = rotation * (inertia * (rotation.transpose() * before)) + dt * contact.torque;
    const Vec3<double>  kicked   = angular_velocity_of(rotation, inertia, inverse, momentum, before, locked);
    const Quat          half     = rotation_by(0.5 * dt * kicked) * start;

    JointLink link;
    link.velocity = bodies.velocity[b];
    link.mobility = Mat3<double>::Zero();
    for (int c = 0; c < 3; ++c)
    {
        if (is_locked(locked, lock_x, c)) { continue; }
        link.mobility(c, c) = 1 / bodies.mass[b];
        link.velocity[c] += dt * link.mobility(c, c) * (contact.force[c] + bodies.mass[b] * gravity[c]);
    }
    link.angular_velocity = angular_velocity_of(half.toRotationMatrix(), inertia, inverse, momentum, before, locked);
    link.response         = response_of(rotation, inverse, inertia, locked);
    link.inverse_mass     = 1 / bodies.mass[b];
    link.inverse_inertia  = inverse.trace();
    return link;
}

/// The same of a body with a prescribed motion, as integrate_prescribed finds it. A held direction yields to no joint.
/// Friction of the axle is that without the joints.
TREAD_HD JointLink prescribed_motion(const BodiesView& bodies, std::int64_t b, const Prescribed& motion,
                                     const ContactWrench& contact, const Vec3<double>& gravity, double dt)
{
    const double        mass    = bodies.mass[b];
    const Mat3<double>  inertia = full(bodies.inertia[b]), inverse = inertia.inverse();
    const Quat          start    = bodies.orientation[b];
    const Mat3<double>  rotation = start.toRotationMatrix();
    const HeldSpin      first    = held_spin(motion, rotation);
    const Vec3<double>& before   = bodies.angular_velocity[b];
    const Vec3<double>  momentum = kick_of(motion, first, rotation, inertia, before, contact.torque, dt).momentum;
    const Vec3<double>  kicked   = angular_velocity_held(first, rotation, inverse, momentum);
    const Mat3<double>  half     = (rotation_by(0.5 * dt * kicked) * start).toRotationMatrix();

    JointLink link;
    link.velocity =
        velocity_after(motion, bodies.position[b][2], bodies.velocity[b], contact.force + mass * gravity, mass, dt);
    link.angular_velocity = angular_velocity_held(held_spin(motion, half), half, inverse, momentum);
    link.mobility         = mobility_of(motion, mass, dt);
    link.response         = response_held(first, rotation, inverse);
    link.inverse_mass     = 1 / mass;
    link.inverse_inertia  = inverse.trace();
    return link;
}

} // namespace tread::dem::joint_solve
