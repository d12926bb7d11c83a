#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

// Rovers on rigid ground. Their wheels are balls: a ball rolls without edges, and touches right below its centre.
namespace tread::test
{

/// Where a rover's parts are, m, and their masses, kg: x z of the centres of mass, from the ground below the rover's
/// origin. Left and right are alike.
struct RoverPart
{
    double mass, x, z;
};

/// Curiosity's lengths (configs/rover/README.md); uprights count to rockers and bogies.
namespace curiosity
{
inline constexpr double                     radius = 0.25, front = 1.095, middle = -0.089, rear = -1.163;
inline constexpr double                     pivot_x = 0.214, pivot_z = 0.8754, bogie_x = -0.54, bogie_z = 0.6433;
inline constexpr RoverPart                  chassis{735, 0.05, 0.9}, rocker{31, 0.28, 0.8}, bogie{21, -0.626, 0.6};
inline constexpr double                     wheel = 10; ///< kg
inline constexpr std::array<double, 3>      axles = {front, middle, rear};
inline constexpr std::array<const char*, 3> names = {"front", "middle", "rear"};
} // namespace curiosity

/// Half of the default, with which a standing rover leaves 1 % of its energy unaccounted.
inline constexpr double rover_contact_share = 0.1;

inline std::string rover_head(const std::string& gravity, double length, double contact_share = rover_contact_share,
                              int nodes = 162)
{
    return fmt::format(R"(
title = "rover"
[domain]
size    = [{}, 4.0, 2.0]
{}
walls   = {{ x = "open", y = "open", bottom = "fixed", top = "open" }}
[time]
contact_share = {}
[[material]]
name    = "wheel"
model   = "elastic"
young   = 2.0e7
poisson = 0.3
[[contact]]
between     = ["wheel", "wall"]
friction    = 1.0
restitution = 0.1
[[shape]]
name      = "ball"
generate  = {{ kind = "sphere", nodes = {} }}
sdf_cells = 24
[[shape]]
name     = "chassis"
generate = {{ kind = "box", size = [1.5, 1.0, 0.5] }}
[[shape]]
name     = "beam"
generate = {{ kind = "box", size = [1.0, 0.05, 0.06] }}
)",
                       length, gravity, contact_share, nodes);
}

inline std::string rover_body(const std::string& name, const std::string& shape, double mass, double x, double y,
                              double z)
{
    return fmt::format("[[body]]\nname = \"{}\"\nshape = \"{}\"\nmaterial = \"wheel\"\nmass = {}\nposition = [{}, {}, "
                       "{}]\n{}",
                       name, shape, mass, x, y, z, shape == "ball" ? "diameter = 0.5\n" : "");
}

inline std::string rover_joint(const std::string& name, const std::string& one, const std::string& other, double x,
                               double y, double z, const std::string& motor = "")
{
    return fmt::format("[[joint]]\nname = \"{}\"\ntype = \"revolute\"\nbetween = [\"{}\", \"{}\"]\nat = [{}, {}, "
                       "{}]\naxis = [0, 1, 0]\n{}\n",
                       name, one, other, x, y, z, motor);
}

inline const std::string differential_text =
    "[[joint]]\nname = \"differential\"\ntype = \"differential\"\njoints = [\"pivot_left\", \"pivot_right\"]\n";

/// Radians by which chassis and rockers turn, nose up, about the pivots of the bogies, when the front wheels stand on a
/// step of that height and the others before it.
inline double climb_of(double step)
{
    using namespace curiosity;
    const double ahead = front - bogie_x, up = radius - bogie_z;
    return std::asin((up + step) / std::hypot(ahead, up)) - std::atan2(up, ahead);
}

/// A part of chassis, rockers or front wheels after that turn.
inline RoverPart climbed(const RoverPart& part, double climb)
{
    using namespace curiosity;
    const double ahead = part.x - bogie_x, up = part.z - bogie_z;
    return {part.mass, bogie_x + std::cos(climb) * ahead - std::sin(climb) * up,
            bogie_z + std::sin(climb) * ahead + std::cos(climb) * up};
}

/// Bodies and joints of six wheels on a rocker-bogie at x = y = 2 m; `brake`: the axle's keys of the rear wheels.
/// Wheels turn freely otherwise. Bodies 5 to 10 are the wheels: front left, front right, middle left, ...
inline std::string six_wheels_parts(double climb, const std::string& brake)
{
    using namespace curiosity;
    constexpr double  x = 2, y = 2, drop = 1e-4;
    const std::string tilt = fmt::format("axis = [0, -1, 0]\nangle_deg = {}\n", climb * 180 / std::numbers::pi);
    const RoverPart   body = climbed(chassis, climb), arm = climbed(rocker, climb),
                    pivot = climbed({0, pivot_x, pivot_z}, climb);
    std::string text      = rover_body("chassis", "chassis", body.mass, x + body.x, y, body.z) + tilt, joints;
    for (const double side : {1.0, -1.0})
    {
        text +=
            rover_body(side > 0 ? "rocker_left" : "rocker_right", "beam", arm.mass, x + arm.x, y + 0.7 * side, arm.z) +
            tilt;
    }
    for (const double side : {1.0, -1.0})
    {
        text += rover_body(side > 0 ? "bogie_left" : "bogie_right", "beam", bogie.mass, x + bogie.x, y + 0.8 * side,
                           bogie.z);
    }
    for (const double side : {1.0, -1.0})
    {
        const std::string hand = side > 0 ? "left" : "right";
        joints += rover_joint("pivot_" + hand, "chassis", "rocker_" + hand, x + pivot.x, y + 0.6 * side, pivot.z);
        joints += rover_joint("bogie_" + hand, "rocker_" + hand, "bogie_" + hand, x + bogie_x, y + 0.8 * side, bogie_z);
    }
    joints += differential_text;
    for (std::size_t w = 0; w < axles.size(); ++w)
    {
        const RoverPart hub = climbed({wheel, axles[w], radius}, w == 0 ? climb : 0);
        for (const double side : {1.0, -1.0})
        {
            const std::string hand = side > 0 ? "left" : "right", name = fmt::format("{}_{}", names[w], hand);
            const double      hub_x = x + hub.x, hub_y = y + 1.2 * side, hub_z = hub.z + drop;
            text += rover_body(name, "ball", hub.mass, hub_x, hub_y, hub_z);
            joints += rover_joint("axle_" + name, (w == 0 ? "rocker_" : "bogie_") + hand, name, hub_x, hub_y, hub_z,
                                  w == 2 ? brake : "");
        }
    }
    return text + joints;
}

/// Six wheels on a plane.
inline std::string six_wheels(const std::string& gravity, double duration, const std::string& brake = "",
                              double contact_share = rover_contact_share)
{
    return rover_head(gravity, 4, contact_share) + six_wheels_parts(0, brake) +
           fmt::format("[[phase]]\nname = \"stand\"\nduration = {}\n", duration);
}

/// Six wheels of which the front ones stand on a step, the last body. Balls meet a body by their nodes: so many of them
/// that they carry some millimetres from the lowest place at most.
inline std::string six_wheels_on_a_step(double step, double duration)
{
    constexpr double  gap  = 0.005; // under the step
    const std::string few  = "nodes = 162";
    std::string       text = rover_head("gravity = [0.0, 0.0, -3.72]", 4) + six_wheels_parts(climb_of(step), "");
    text.replace(text.find(few), few.size(), "nodes = 2562");
    text += fmt::format("[[shape]]\nname = \"step\"\ngenerate = {{ kind = \"box\", size = [0.9, 3.2, {}] }}\n"
                        "sdf_cells = 160\n",
                        step - gap);
    text += rover_body("step", "step", 1000, 3.2, 2, 0.5 * (step + gap));
    return text + fmt::format("[[phase]]\nname = \"stand\"\nduration = {}\nhold = [\"step\"]\n", duration);
}

/// A rover of four wheels: masses in kg, heights of its parts over flat ground and half of its length and width in m.
namespace four
{
inline constexpr double radius = 0.25, half_length = 0.7, half_width = 1.0;
inline constexpr double chassis = 150, chassis_z = 0.9, rocker = 10, rocker_z = 0.8, wheel = 10;
} // namespace four

/// The four wheels driven against a step of 0.15 m on the left for `drive` s, then braked for 1 s, then for 1 s on
/// ground without friction. Bodies 1 and 2 are the rockers, 3 to 6 the wheels: front left, front right, rear left, rear
/// right; the last body is the step. Nodes of a wheel are 2 cm apart: it stands on the step on some five of them, right
/// below its axle.
inline std::string four_wheels_before_a_step(double drive)
{
    using namespace four;
    constexpr double  x = 1.2, y = 2, drop = 1e-4;
    std::string       text  = rover_head("gravity = [0.0, 0.0, -3.72]", 6, rover_contact_share, 2562), joints, brakes;
    const std::string motor = "motor = { speed = 1.6, max_torque = 60, gain = 200 }";
    text += rover_body("chassis", "chassis", chassis, x, y, chassis_z);
    for (const double side : {1.0, -1.0})
    {
        const std::string hand = side > 0 ? "left" : "right";
        text += rover_body("rocker_" + hand, "beam", rocker, x, y + 0.7 * side, rocker_z);
        joints += rover_joint("pivot_" + hand, "chassis", "rocker_" + hand, x, y + 0.6 * side, rocker_z);
    }
    joints += differential_text;
    for (const double end : {1.0, -1.0})
    {
        for (const double side : {1.0, -1.0})
        {
            const std::string hand = side > 0 ? "left" : "right", name = (end > 0 ? "front_" : "rear_") + hand;
            const double      hub_x = x + end * half_length, hub_y = y + half_width * side, hub_z = radius + drop;
            text += rover_body(name, "ball", wheel, hub_x, hub_y, hub_z);
            joints += rover_joint("axle_" + name, "rocker_" + hand, name, hub_x, hub_y, hub_z, motor);
            brakes += fmt::format("{{ joint = \"axle_{}\", speed = 0.0 }}, ", name);
        }
    }
    text += "[[contact]]\nbetween = [\"wheel\", \"wheel\"]\nfriction = 1.0\nrestitution = 0.1\n"
            "[[shape]]\nname = \"step\"\ngenerate = { kind = \"box\", size = [3.0, 1.2, 0.145] }\n";
    text += rover_body("step", "step", 1000, 2.3 + 1.5, y + 1.0, 0.0775);
    return text + joints +
           fmt::format("[[phase]]\nname = \"drive\"\nduration = {}\nhold = [\"step\"]\n"
                       "[[phase]]\nname = \"stop\"\nduration = 1\nhold = [\"step\"]\nmotors = [ {} ]\n"
                       "[[phase]]\nname = \"stand\"\nduration = 1\nhold = [\"step\"]\n"
                       "contacts = [ {{ between = [\"wheel\", \"wheel\"], friction = 0.0 }}, {{ between = [\"wheel\", "
                       "\"wall\"], friction = 0.0 }} ]\n",
                       drive, brakes);
}

} // namespace tread::test
