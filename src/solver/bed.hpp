#pragma once

#include <string>
#include <vector>

#include "io/summary.hpp"
#include "solver/world.hpp"

namespace tread::solver
{

/// What the [[terrain]] and [[rocks]] tables of a scene became.
io::BedReport describe_bed(const scene::Scene& scene, const World& world);

/// One line a table, for the log and `tread check`.
std::vector<std::string> bed_lines(const io::BedReport& bed);

} // namespace tread::solver
