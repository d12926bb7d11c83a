#pragma once

#include <string>

#include "solver/plan.hpp"

namespace tread::run
{

/// Returns "; by model ...": the memory and time on one core that a stage left out by the plan would have cost, per
/// item and for all items of the scene. Empty where there is no model.
std::string price_text(const solver::Stage& stage, const scene::Scene& scene, const world::World& world);

} // namespace tread::run
