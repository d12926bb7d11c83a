#pragma once

#include "solver/plan.hpp"
#include "solver/time_step.hpp"

namespace tread::solver
{

/// Bounds on the time step that hold for the whole run.
PaceLimits pace_limits(const scene::Scene& scene, const world::World& world, const Plan& plan);

} // namespace tread::solver
