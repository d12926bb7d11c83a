#pragma once

#include <string>
#include <vector>

#include "run/drive_room.hpp"
#include "run/estimate.hpp"
#include "solver/plan.hpp"
#include "world/world.hpp"

// What a scene says that can be computed but is hardly meant: wrong units, a wheel beside the sand, a day of wall time.
namespace tread::run
{

struct Warning
{
    std::string where; ///< "sand.toml:41", the line of the table; empty if unknown
    std::string text;  ///< table, key, value, and the value that looks meant
};

/// "sand.toml:41: [[material]] 'sand': density = 1.6 kg/m3 ...".
std::string text_of(const Warning& warning);

/// Warnings of gravity and materials.
std::vector<Warning> implausible_ground(const scene::Scene& scene);

/// Warnings of contacts and phases.
std::vector<Warning> implausible_commands(const scene::Scene& scene);

/// Warnings of bodies and what they stand on: place, weight, size, speed.
std::vector<Warning> implausible_bodies(const scene::Scene& scene, const world::World& world);

/// Warnings of the step and of what the run costs.
std::vector<Warning> implausible_cost(const scene::Scene& scene, const world::World& world, const Estimate& wants);

/// All of them, and drives too long for their bed (`rooms`: of drive_rooms). Where gravity or a material looks wrong,
/// what would follow for bodies is left out.
std::vector<Warning> plausibility(const scene::Scene& scene, const world::World& world, const Estimate& wants,
                                  const std::vector<DriveRoom>& rooms);

} // namespace tread::run
