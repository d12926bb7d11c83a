#pragma once

#include <cstdint>

#include "kernels/dem/bodies.hpp"
#include "kernels/dem/motion/impulses.hpp"

namespace tread::dem
{

/// Bit of Prescribed::held beside those of LockedFreedom: rotation about the body's own y axis.
inline constexpr std::uint32_t hold_axle = 64;

/// Prescribed motion of a named body: velocities that are held whatever the forces, and forces that act besides contact
/// and gravity. If hold_axle is set, lock_pitch is not.
struct Prescribed
{
    Mat3<double>  frame;         ///< directions of x y z as columns, world frame; orthonormal
    Mat3<double>  turn_frame;    ///< directions of roll pitch yaw, likewise
    Vec3<double>  velocity;      ///< m/s along x y z, of the held ones
    Vec3<double>  spin;          ///< rad/s about roll pitch yaw, of the held ones
    Vec3<double>  force;         ///< N, world frame
    Vec3<double>  torque;        ///< N m, world frame
    double        axle_spin;     ///< rad/s, if hold_axle is set
    double        axle_torque;   ///< N m about the body's y axis
    double        axle_friction; ///< N m, limit of Coulomb's torque against rotation about the body's y axis
    double        stiffness;     ///< N/m, of a vertical spring to a carriage
    double        damping;       ///< N s/m, of a damper beside it
    double        height;        ///< m, centre of mass at which the spring is at rest
    std::uint32_t held;          ///< bits of LockedFreedom, by these axes, and hold_axle

    bool operator==(const Prescribed&) const = default;
};

/// A motion that prescribes nothing, with the world's axes.
inline Prescribed no_motion()
{
    const Vec3<double> none = Vec3<double>::Zero();
    return {Mat3<double>::Identity(), Mat3<double>::Identity(), none, none, none, none, 0, 0, 0, 0, 0, 0, 0};
}

/// Motions of the named bodies and impulses of their reactions; null if no body of the scene has a motion.
struct PrescribedView
{
    const Prescribed* motion   = nullptr; ///< of each named body; read for bodies with the flag `prescribed`
    ContactImpulse*   reaction = nullptr; ///< of each named body
};

} // namespace tread::dem
