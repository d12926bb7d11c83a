#pragma once

#include <string>

namespace tread::test
{

/// Appended to a scene of 0.4 x 0.4 m: a roller of 6 kg with grousers, thrown onto its contents.
inline const std::string thrown_roller_text = R"(
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e9
poisson = 0.3
[[shape]]
name      = "roller"
generate  = { kind = "wheel", radius = 0.1, width = 0.15, wall_thickness = 0.04, grousers = 6 }
sdf_cells = 48
node_spacing = 0.008
[[body]]
name     = "roller"
shape    = "roller"
material = "steel"
mass     = 6.0
velocity = [0.2, 0.0, -1.0]
position = [0.2, 0.2, 0.32]
)";

} // namespace tread::test
