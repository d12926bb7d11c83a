#pragma once

#include <cstdint>

#include "backend/vector.hpp"

// Joints between rigid bodies: what a scene says of them, and what a run leaves of them. docs/theory.md#joints.
namespace tread::dem
{

enum JointKind : std::int32_t
{
    joint_revolute,     ///< turns about its axis
    joint_prismatic,    ///< slides along its axis
    joint_spherical,    ///< turns about its point
    joint_fixed,        ///< neither turns nor slides
    joint_differential, ///< the angles of two revolute joints have the sum zero
    joint_spring,       ///< spring and damper along the line between two points; ties nothing
};

/// Parts of a joint that act along its coordinate: the angle (rad) of a revolute joint, the displacement (m) of a
/// prismatic one, the length (m) of a spring.
enum JointPart : std::uint32_t
{
    joint_has_spring = 1,
    joint_has_motor  = 2,
    joint_has_limits = 4,
};

inline constexpr std::int32_t joint_world = -1; ///< side of a joint that is the world

/// A joint between the bodies a = side 0 and b = side 1. Its coordinate counts the motion of b relative to a along or
/// about the z axis of the joint's frame. Units of the parts: N and m, or N m and rad.
struct Joint
{
    std::int32_t  kind;
    std::int32_t  body[2];               ///< index of the body, or joint_world
    Vec3<double>  point[2];              ///< m, body frame; of the world: world frame
    Quat          frame[2];              ///< joint's frame to the body's; equal in the world at the start
    std::uint32_t parts      = 0;        ///< bits of JointPart
    std::int32_t  couples[2] = {-1, -1}; ///< differential: the two revolute joints
    std::int32_t  first_row  = 0;
    std::int32_t  row_count  = 0;

    double stiffness = 0, damping = 0, rest = 0; ///< spring: force = stiffness (rest - coordinate) - damping rate
    double low = 0, high = 0;                    ///< limits of the coordinate
    double speed = 0, most_effort = 0, gain = 0; ///< motor: gain (speed - rate), at most most_effort; gain 0: no slip
};

/// What a joint did since it was cleared. Angles in rad.
struct JointRecord
{
    Vec3<double> impulse;         ///< N s, on b
    Vec3<double> angular_impulse; ///< N m s, on b, about the joint's point
    double       motor_impulse;   ///< N s or N m s along the coordinate; of a differential: its own, on both axes
    double       gap;             ///< m, largest distance of the two points in directions that are tied
    double       misalignment;    ///< rad, largest angle in directions that are tied
    double       excess;          ///< m or rad, farthest beyond a limit; negative: below the low one
    double       coordinate;      ///< m or rad, at the start of the last substep; an angle in (-pi, pi]
};

/// Wrench of all joints on one body, world frame, over the last substep. N and N m about the centre of mass.
struct JointWrench
{
    Vec3<double> force;
    Vec3<double> torque;
    Vec3<double> working_force; ///< the part from springs, motors and limits, which do work
    Vec3<double> working_torque;
};

/// View of the wrenches for the integration.
struct JointWrenches
{
    const std::int32_t* place  = nullptr; ///< [bodies], index in `wrench`; -1: no joint; null: the scene has none
    const JointWrench*  wrench = nullptr;
};

} // namespace tread::dem
