#pragma once

#include <string>
#include <vector>

#include "run/drive_room.hpp"
#include "run/wall_time.hpp"

namespace tread::run
{

/// `tread check --json`: one object, SI units, names as in docs/output.md. What a scene does not have is null or an
/// empty array.
std::string check_json(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
                       const Estimate& wants, const Expected& expected, const std::vector<DriveRoom>& rooms);

} // namespace tread::run
