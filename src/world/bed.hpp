#pragma once

#include <string>
#include <vector>

#include "io/summary.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// Describes the bed built from the [[terrain]] and [[rocks]] tables of a scene.
io::BedReport describe_bed(const scene::Scene& scene, const World& world);

/// One line per table, for the log and `tread check`.
std::vector<std::string> bed_lines(const io::BedReport& bed);

} // namespace tread::world
