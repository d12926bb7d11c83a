#pragma once

#include <array>
#include <optional>
#include <string>

#include "scene/words.hpp"

// Joints between bodies, as plain data; joint_keys.cpp describes how they are read.
namespace tread::scene
{

/// Side of a joint that is not a body.
inline constexpr const char* world_side = "world";

/// Motor about the axis of a revolute joint.
struct Motor
{
    double                speed      = 0; ///< rad/s
    double                max_torque = 0; ///< N m
    std::optional<double> gain;           ///< N m s/rad; empty: as much torque as the speed needs
    std::string           from;           ///< phase from which the speed holds; before it is 0. Empty: the first one

    bool operator==(const Motor&) const = default;
};

/// What a motor does from a phase on.
struct MotorSetting
{
    std::string           joint;
    double                speed = 0;  ///< rad/s
    std::optional<double> max_torque; ///< N m; empty: as before

    bool operator==(const MotorSetting&) const = default;
};

/// Lowest and highest value of a joint's coordinate, m or degrees.
using JointLimits = std::array<double, 2>;

struct Joint
{
    std::string                name;
    JointType                  type = JointType::revolute;
    std::array<std::string, 2> between;    ///< bodies a and b, or world_side; the coordinate counts b against a
    std::array<double, 3>      at{};       ///< m, world frame, at the start; of a spring: its point on a
    std::array<double, 3>      to{};       ///< m, likewise: a spring's point on b
    std::array<double, 3>      axis{};     ///< of any length but 0, world frame, at the start
    std::array<std::string, 2> joints;     ///< the revolute joints of a differential
    std::optional<JointLimits> limits;     ///< m, of a prismatic joint
    std::optional<JointLimits> limits_deg; ///< of a revolute joint
    std::optional<double>      stiffness;  ///< N/m or N m/rad
    std::optional<double>      damping;    ///< N s/m or N m s/rad
    std::optional<double>      length;     ///< m, of a spring without load; empty: its length at the start
    std::optional<Motor>       motor;
    double                     drift = 1e-4; ///< m and rad, error or way beyond a limit at which the run stops

    bool operator==(const Joint&) const = default;
};

} // namespace tread::scene
