#pragma once

#include "kernels/dem/motion/integrate_kern.hpp"
#include "kernels/dem/motion/prescribed.hpp"

// One substep of a body with a prescribed motion, by the scheme of integrate_kern.hpp. The reaction is all that acts on
// the body besides contact and gravity: d(m v)/dt = contact + m g + reaction, and likewise for the angular momentum.
namespace tread::dem
{

/// Axes about which the angular velocity is held, at one orientation.
struct HeldSpin
{
    Mat3<double>  axes; ///< columns; unit vectors
    Vec3<double>  rate; ///< rad/s
    std::uint32_t held; ///< bit i: column i is held
};

TREAD_HD HeldSpin held_spin(const Prescribed& motion, const Mat3<double>& rotation)
{
    HeldSpin spin{motion.turn_frame, motion.spin, (motion.held / lock_roll) & 7u};
    if ((motion.held & hold_axle) != 0)
    {
        spin.axes.col(1) = rotation.col(1);
        spin.rate[1]     = motion.axle_spin;
        spin.held |= 2u;
    }
    return spin;
}

/// Solves J omega = momentum + sum of lambda_i a_i for omega, with multipliers lambda of the held axes a_i such that
/// a_i . omega is the held rate.
TREAD_HD Vec3<double> angular_velocity_held(const HeldSpin& spin, const Mat3<double>& rotation,
                                            const Mat3<double>& inverse_inertia, const Vec3<double>& momentum)
{
    if (spin.held == 7u)
    {
        const Mat3<double> across = spin.axes.transpose();
        return across.inverse() * spin.rate;
    }
    const Mat3<double> inverse = rotation * inverse_inertia * rotation.transpose();
    Vec3<double>       free    = inverse * momentum;
    if (spin.held == 0) { return free; }
    Mat3<double> response = spin.axes.transpose() * inverse * spin.axes;
    Vec3<double> missing  = spin.rate - spin.axes.transpose() * free;
    for (int i = 0; i < 3; ++i)
    {
        if ((spin.held >> i & 1u) != 0) { continue; }
        response.row(i).setZero();
        response.col(i).setZero();
        response(i, i) = 1;
        missing[i]     = 0;
    }
    const Vec3<double> multiplier = response.inverse() * missing;
    return free + inverse * (spin.axes * multiplier);
}

/// Change of angular_velocity_held by a unit of momentum, 1/(kg m2).
TREAD_HD Mat3<double> response_held(const HeldSpin& spin, const Mat3<double>& rotation,
                                    const Mat3<double>& inverse_inertia)
{
    const HeldSpin still{spin.axes, Vec3<double>::Zero(), spin.held};
    Mat3<double>   response;
    for (int c = 0; c < 3; ++c)
    {
        response.col(c) = angular_velocity_held(still, rotation, inverse_inertia, Vec3<double>::Unit(c));
    }
    return response;
}

/// Force (N) of the carriage along z. The damper acts on the mean velocity of the step under `others` (N), the other
/// vertical forces, so that no damping constant is unstable.
TREAD_HD double carriage_force(const Prescribed& motion, double z, double velocity, double others, double mass,
                               double dt)
{
    const double spring = -motion.stiffness * (z - motion.height);
    const double half   = 0.5 * dt / mass;
    return spring - motion.damping * (velocity + half * (others + spring)) / (1 + half * motion.damping);
}

/// Velocity after a step of dt (s) of a body at the height z (m) that had the velocity `before`, under `outer` (N), all
/// forces but those of the motion.
TREAD_HD Vec3<double> velocity_after(const Prescribed& motion, double z, const Vec3<double>& before,
                                     const Vec3<double>& outer, double mass, double dt)
{
    Vec3<double> acting = outer + motion.force;
    acting[2] += carriage_force(motion, z, before[2], acting[2], mass, dt);
    Vec3<double> along = motion.frame.transpose() * (before + dt / mass * acting);
    for (int c = 0; c < 3; ++c)
    {
        if (is_locked(motion.held, lock_x, c)) { along[c] = motion.velocity[c]; }
    }
    return motion.frame * along;
}

/// Change of velocity_after by a unit impulse, 1/kg.
TREAD_HD Mat3<double> mobility_of(const Prescribed& motion, double mass, double dt)
{
    Mat3<double> along = motion.frame.transpose();
    along.col(2) /= 1 + 0.5 * dt / mass * motion.damping;
    for (int c = 0; c < 3; ++c)
    {
        if (is_locked(motion.held, lock_x, c)) { along.row(c).setZero(); }
    }
    return motion.frame * along / mass;
}

/// Moves a body by dt (s); `gravity` in m/s2. Adds the reaction's work to `total`, and its impulse to both. Returns the
/// velocity at mid-step.
TREAD_HD Vec3<double> translate_prescribed(const Prescribed& motion, BodyMotion& body, const Vec3<double>& contact,
                                           const Vec3<double>& gravity, double dt, BodyTotal& total,
                                           ContactImpulse& reaction)
{
    const Vec3<double> before = body.velocity, outer = contact + body.mass * gravity;
    const Vec3<double> after   = velocity_after(motion, body.position[2], before, outer, body.mass, dt);
    Vec3<double>       mean    = 0.5 * (before + after);
    const Vec3<double> impulse = body.mass * (after - before) - dt * outer;
    total.holding_impulse += impulse;
    total.holding_work += impulse.dot(mean);
    reaction.linear += impulse;
    body.velocity = after;
    body.position += dt * after;
    return mean;
}

/// Impulse (N m s) about the axle of Coulomb's friction: as much as stops the rotation about it, up to the limit.
TREAD_HD double axle_friction(const Prescribed& motion, const HeldSpin& spin, const Mat3<double>& rotation,
                              const Mat3<double>& inverse_inertia, const Vec3<double>& momentum, double dt)
{
    if (motion.axle_friction == 0) { return 0; }
    const Vec3<double> axle    = rotation.col(1);
    const double       sliding = axle.dot(angular_velocity_held(spin, rotation, inverse_inertia, momentum));
    const HeldSpin     still{spin.axes, Vec3<double>::Zero(), spin.held};
    const double       yielding = axle.dot(angular_velocity_held(still, rotation, inverse_inertia, axle));
    const double       most     = dt * motion.axle_friction;
    if (!(yielding > 0)) { return 0; }
    const double stops = -sliding / yielding;
    return stops > most ? most : stops < -most ? -most : stops;
}

/// What a substep adds to the angular momentum of a body before it turns. N m s.
struct SpinKick
{
    Vec3<double> driving;  ///< impulse of the motion's torques
    Vec3<double> rubbing;  ///< impulse of the axle's friction
    Vec3<double> momentum; ///< angular momentum with these and the torque of contacts
};

/// `first`: axes held at the orientation `rotation`; `spin`: rad/s, at the start; `torque`: N m, of all but the motion.
TREAD_HD SpinKick kick_of(const Prescribed& motion, const HeldSpin& first, const Mat3<double>& rotation,
                          const Mat3<double>& inertia, const Vec3<double>& spin, const Vec3<double>& torque, double dt)
{
    const Vec3<double> present = rotation * (inertia * (rotation.transpose() * spin));
    const Vec3<double> driving = dt * (motion.torque + motion.axle_torque * rotation.col(1));
    const Vec3<double> driven  = present + dt * torque + driving;
    const Vec3<double> rubbing =
        axle_friction(motion, first, rotation, inertia.inverse(), driven, dt) * rotation.col(1);
    return {driving, rubbing, driven + rubbing};
}

/// Rotates a body likewise under the contact torque; returns the angular velocity over the step.
TREAD_HD Vec3<double> rotate_prescribed(const Prescribed& motion, BodyMotion& body, const Vec3<double>& torque,
                                        double dt, BodyTotal& total, ContactImpulse& reaction)
{
    const Mat3<double> inertia = full(body.inertia), inverse = inertia.inverse();
    const Quat         start    = body.orientation;
    const Vec3<double> before   = body.angular_velocity;
    const Mat3<double> at_start = start.toRotationMatrix();
    const HeldSpin     first    = held_spin(motion, at_start);
    const SpinKick     kick     = kick_of(motion, first, at_start, inertia, before, torque, dt);

    const Vec3<double> kicked     = angular_velocity_held(first, at_start, inverse, kick.momentum);
    const Mat3<double> half       = (rotation_by(0.5 * dt * kicked) * start).toRotationMatrix();
    const Vec3<double> middle     = angular_velocity_held(held_spin(motion, half), half, inverse, kick.momentum);
    body.orientation              = made_unit(rotation_by(dt * middle) * start);
    const Mat3<double> at_end     = body.orientation.toRotationMatrix();
    const HeldSpin     last       = held_spin(motion, at_end);
    body.angular_velocity         = angular_velocity_held(last, at_end, inverse, kick.momentum);
    const Vec3<double> reached    = at_end * (inertia * (at_end.transpose() * body.angular_velocity));
    const Vec3<double> after_kick = at_start * (inertia * (at_start.transpose() * kicked));
    Vec3<double>       mean       = 0.5 * (before + kicked);
    const bool         is_held    = first.held != 0;
    const Vec3<double> kick_impulse =
        is_held ? Vec3<double>(after_kick - kick.momentum) : Vec3<double>(Vec3<double>::Zero());
    const Vec3<double> turn_impulse = is_held ? Vec3<double>(reached - after_kick) : Vec3<double>(Vec3<double>::Zero());

    total.friction -= kick.rubbing.dot(mean);
    total.holding_work +=
        (kick.driving + kick_impulse).dot(mean) + turn_impulse.dot(0.5 * (kicked + body.angular_velocity));
    reaction.angular += kick.driving + kick.rubbing + kick_impulse + turn_impulse;
    return mean;
}

/// Integrates translation and rotation over a step. Local damping leaves such bodies alone.
TREAD_HD MeanMotion integrate_prescribed(const Prescribed& motion, BodyMotion& body, const ContactWrench& contact,
                                         const Vec3<double>& gravity, double dt, BodyTotal& total,
                                         ContactImpulse& reaction)
{
    const Vec3<double> velocity = translate_prescribed(motion, body, contact.force, gravity, dt, total, reaction);
    return {velocity, rotate_prescribed(motion, body, contact.torque, dt, total, reaction)};
}

} // namespace tread::dem
