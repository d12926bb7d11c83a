#pragma once

#include <string>
#include <vector>

#include "run/drive_room.hpp"
#include "run/estimate.hpp"
#include "solver/plan.hpp"
#include "world/world.hpp"

// Warnings of scenes that can be computed but are probably not intended: wrong units, a wheel beside the sand, a day
// of wall time.
namespace tread::run
{

struct Warning
{
    std::string where; ///< "sand.toml:41", the line of the table; empty if unknown
    std::string text;  ///< table, key, value, and the value probably intended
};

/// "sand.toml:41: [[material]] 'sand': density = 1.6 kg/m3 ...".
std::string text_of(const Warning& warning);

/// Warns of implausible gravity and materials.
std::vector<Warning> implausible_ground(const scene::Scene& scene);

/// Warns of implausible contacts and phases.
std::vector<Warning> implausible_commands(const scene::Scene& scene);

/// Warns of bodies and their ground: position, weight, size, speed.
std::vector<Warning> implausible_bodies(const scene::Scene& scene, const world::World& world);

/// Warns of the time step and the cost of the run.
std::vector<Warning> implausible_cost(const scene::Scene& scene, const world::World& world, const Estimate& wants);

/// Collects all warnings, and those of drives too long for their bed (`rooms`: from drive_rooms). Where gravity or a
/// material looks wrong, warnings of bodies that would follow from it are left out.
std::vector<Warning> plausibility(const scene::Scene& scene, const world::World& world, const Estimate& wants,
                                  const std::vector<DriveRoom>& rooms);

} // namespace tread::run
