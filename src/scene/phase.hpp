#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/joint.hpp"
#include "scene/motion.hpp"
#include "scene/vector3.hpp"
#include "scene/words.hpp"

// Settings of a phase of simulated time, as plain data; scene.hpp describes how it is read.
namespace tread::scene
{

struct Drive
{
    std::string           body;
    double                angular_velocity = 0; ///< rad/s about the axle; positive drives towards +x
    double                ramp             = 0; ///< s, linear from the value at the start of the phase
    std::optional<double> slip;                 ///< 1 - v_x/(omega r); if empty, v_x is free

    bool operator==(const Drive&) const = default;
};

/// Lowers a body at a given speed until the ground carries a share of its weight.
struct Lower
{
    std::string body;
    double      speed = 0; ///< m/s, downwards: along gravity
    double      share = 1; ///< of its weight, carried by contacts at the end

    bool operator==(const Lower&) const = default;
};

/// Share of a body's weight that acts in a phase; a support that moves with the body carries the rest.
struct WeightShare
{
    std::string body;
    double      from = 1; ///< at phase start
    double      to   = 1; ///< after the ramp
    double      ramp = 0; ///< s, linear

    bool operator==(const WeightShare&) const = default;
};

/// What changes in the contact of a pair of families.
struct ContactSetting
{
    std::array<std::string, 2> between;
    std::optional<double>      friction;    ///< empty: as before
    std::optional<double>      restitution; ///< likewise; body-body only
    std::optional<bool>        touch;       ///< likewise

    bool operator==(const ContactSetting&) const = default;
};

struct Phase
{
    std::string                name;
    std::vector<std::string>   hold;
    double                     damping      = 0; ///< local (Cundall) damping of sand and rocks
    StopRule                   until        = StopRule::duration;
    double                     duration     = 0; ///< s
    double                     max_duration = 0; ///< s, for until = "equilibrium" and "lowered"
    std::optional<Drive>       drive;
    std::optional<Lower>       lower;  ///< only with until = "lowered"
    std::optional<WeightShare> weight; ///< empty: the full weight of every body acts
    std::vector<Motion>        motion; ///< one for each body that has one

    // From this phase on, until another one sets them.
    std::vector<MotorSetting>   motors;  ///< of joints
    std::optional<Vector3>      gravity; ///< m/s2
    std::vector<ContactSetting> contacts;
    std::optional<double>       mass_scaling; ///< TimeOptions::mass_scaling

    bool operator==(const Phase&) const = default;
};

/// s, simulated time after which the phase ends at the latest.
inline double time_limit(const Phase& phase)
{
    return phase.until == StopRule::duration ? phase.duration : phase.max_duration;
}

/// Motion of a body in a phase; null if it has none.
inline const Motion* motion_of(const Phase& phase, const std::string& body)
{
    const auto at = std::find_if(phase.motion.begin(), phase.motion.end(),
                                 [&](const Motion& motion) { return motion.body == body; });
    return at == phase.motion.end() ? nullptr : &*at;
}

} // namespace tread::scene
