#pragma once

#include <string>

#include "solver/plan.hpp"

namespace tread::run
{

/// "; by model ...": what a stage that the plan leaves out would have cost, memory and time of one core, for each of
/// the things that it works on, and for all of them that the scene has. Empty where there is no model.
std::string price_text(const solver::Stage& stage, const scene::Scene& scene, const world::World& world);

} // namespace tread::run
