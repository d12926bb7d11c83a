#pragma once

#include "solver/plan.hpp"
#include "solver/time_step.hpp"

namespace tread::solver
{

/// What bounds the steps of a scene from its start to its end.
PaceLimits pace_limits(const scene::Scene& scene, const world::World& world, const Plan& plan);

} // namespace tread::solver
