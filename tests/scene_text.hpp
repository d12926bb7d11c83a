#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "scene/load.hpp"
#include "temporary_directory.hpp"

// Scenes for tests, as a user would write them, read by the same loader.
namespace tread::test
{

inline scene::Scene load_text(const std::string& text, const std::vector<std::string>& overrides = {})
{
    const TemporaryDirectory folder;
    const std::string        path = folder.path("scene.toml");
    std::ofstream(path) << text;
    return scene::load_scene(path, overrides);
}

/// A box of sand with a fixed floor, small enough for a test of a second.
inline const std::string sand_text = R"(
title = "sand"
[domain]
size    = [0.4, 0.4, 0.6]
gravity = [0.0, 0.0, -9.81]
[grid]
spacing = 0.05
[[material]]
name               = "sand"
model              = "mohr-coulomb"
density            = 1600.0
young              = 1.0e6
poisson            = 0.3
friction_angle_deg = 30.0
[[terrain]]
material = "sand"
region   = { box = [[0.0, 0.0, 0.0], [0.4, 0.4, 0.2]] }
[[phase]]
name     = "rest"
duration = 0.05
[output]
every = 0.01
)";

/// Appended: rocks of 6 cm.
inline const std::string rocks_text = R"(
[[material]]
name    = "rock"
model   = "elastic"
density = 2700.0
young   = 1.0e7
poisson = 0.25
[[shape]]
name      = "clast"
generate  = { kind = "rock", seed = 3, aspect = 0.7, sphericity = 0.9, nodes = 162 }
sdf_cells = 24
[[rocks]]
shape    = "clast"
material = "rock"
count    = 8
diameter = 0.06
region   = { box = [[0.0, 0.0, 0.02], [0.4, 0.4, 0.2]] }
)";

/// Steel that is soft enough for long steps.
inline const std::string soft_steel_text = R"(
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e9
poisson = 0.3
)";

/// The sand, and a roller of 4 kg above it that can only fall.
inline const std::string roller_text = sand_text + soft_steel_text + R"(
[[shape]]
name      = "roller"
generate  = { kind = "wheel", radius = 0.1, width = 0.15, wall_thickness = 0.04, grousers = 0, grouser_height = 0.0 }
sdf_cells = 48
node_spacing = 0.0125
[[body]]
name     = "roller"
shape    = "roller"
material = "steel"
mass     = 4.0
position = [0.2, 0.2, 0.33]
lock     = ["x", "y", "roll", "pitch", "yaw"]
)";

/// No gravity, walls or [time]: steel for balls. Append [time], bodies of shape "ball", and phases.
inline const std::string steel_text = R"(
title = "steel balls"
[domain]
size    = [4.0, 1.0, 1.0]
gravity = [0.0, 0.0, 0.0]
walls   = { x = "open", y = "open", bottom = "open", top = "open" }
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e10
poisson = 0.3
[[contact]]
between     = ["steel", "steel"]
restitution = 1.0
[[shape]]
name      = "ball"
generate  = { kind = "sphere", nodes = 162 }
sdf_cells = 24
)";

} // namespace tread::test
