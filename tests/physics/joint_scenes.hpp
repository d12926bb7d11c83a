#pragma once

#include <string>

#include "scene_text.hpp"

// Scenes of jointed bodies.
namespace tread::test
{

/// A chain of two balls of 10 kg that swings from a pin over the sand, and a third that a motor spins from the phase
/// "drive" on. The last phase has the given duration (s).
inline std::string swinging_text(double duration)
{
    return steel_text + R"(
[time]
dt = 1e-3
substeps = 20
[[body]]
name = "upper"
shape = "ball"
material = "steel"
diameter = 0.1
mass = 10
position = [2.3, 0.5, 0.8]
[[body]]
name = "lower"
shape = "ball"
material = "steel"
diameter = 0.1
mass = 10
position = [2.6, 0.5, 0.8]
[[body]]
name = "spun"
shape = "ball"
material = "steel"
diameter = 0.1
mass = 10
position = [1.0, 0.5, 0.5]
[[joint]]
name = "pin"
type = "revolute"
between = ["world", "upper"]
at = [2.0, 0.5, 0.8]
axis = [0, 1, 0]
limits_deg = [-10, 170]
[[joint]]
name = "elbow"
type = "revolute"
between = ["upper", "lower"]
at = [2.45, 0.5, 0.8]
axis = [0, 1, 0]
stiffness = 2
damping = 0.05
[[joint]]
name = "axle"
type = "revolute"
between = ["world", "spun"]
at = [1.0, 0.5, 0.5]
axis = [0, 1, 0]
motor = { speed = 6, max_torque = 0.3, from = "drive" }
[[phase]]
name = "hold"
duration = 0.01
hold = ["upper", "lower", "spun"]
[[phase]]
name = "drive"
duration = )" +
           std::to_string(duration) + "\n";
}

/// The same under gravity.
inline std::string swinging_under_gravity(double duration)
{
    std::string       text = swinging_text(duration);
    const std::string none = "gravity = [0.0, 0.0, 0.0]";
    return text.replace(text.find(none), none.size(), "gravity = [0.0, 0.0, -9.81]");
}

/// Two balls of 10 kg under gravity, high above the floor, the second welded to the first at its side, and a last phase
/// with this motion of the first.
inline std::string moved_text(double duration, const std::string& motion)
{
    std::string       text = steel_text + R"(
[time]
dt = 1e-3
substeps = 20
[[body]]
name = "led"
shape = "ball"
material = "steel"
diameter = 0.1
mass = 10
position = [1.0, 0.5, 0.8]
[[body]]
name = "follower"
shape = "ball"
material = "steel"
diameter = 0.1
mass = 10
position = [1.2, 0.5, 0.8]
[[joint]]
name = "weld"
type = "fixed"
between = ["led", "follower"]
at = [1.1, 0.5, 0.8]
[[phase]]
name = "move"
)";
    const std::string none = "gravity = [0.0, 0.0, 0.0]";
    text.replace(text.find(none), none.size(), "gravity = [0.0, 0.0, -9.81]");
    const std::string open = "bottom = \"open\"";
    text.replace(text.find(open), open.size(), "bottom = \"fixed\"");
    return text + "duration = " + std::to_string(duration) + "\nmotion = [ { body = \"led\", " + motion + " } ]\n";
}

} // namespace tread::test
