#pragma once

#include "scene/document.hpp"
#include "scene/problems.hpp"
#include "scene/scene.hpp"

namespace tread::scene
{

/// Adds to each [[material]] with a `soil` the constants of that soil which the table leaves out and its model takes.
/// Returns what was taken. Under "bolton" either of `density` and `relative_density` gives the other, by the density of
/// the grains. Reports a problem if both are given and contradict each other, if neither is, or if the density is none
/// between the loosest and the densest packing.
SoilUses fill_from_soils(Node& document, Problems& problems);

} // namespace tread::scene
