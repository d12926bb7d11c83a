#pragma once

#include <string>
#include <vector>

#include "io/summary.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// What the [[terrain]] and [[rocks]] tables of a scene became.
io::BedReport describe_bed(const scene::Scene& scene, const World& world);

/// One line a table, for the log and `tread check`.
std::vector<std::string> bed_lines(const io::BedReport& bed);

} // namespace tread::world
