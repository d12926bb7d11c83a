#pragma once

#include <string>
#include <vector>

#include "run/drive_room.hpp"

namespace tread::run
{

/// Lines of `tread check` on the phases: length, what ends each, and what moves.
std::string phase_lines(const scene::Scene& scene, const std::vector<DriveWay>& ways);

} // namespace tread::run
