#pragma once

#include <string>

#include "run/estimate.hpp"
#include "world/world.hpp"

namespace tread::run
{

/// Cost model of a step, s: step + point * points + body * bodies, and for each substep after the first one substep +
/// body_substep * bodies.
struct StepCost
{
    double step;
    double point;
    double body;
    double substep;
    double body_substep;
};

/// One H200 and one CPU core (docs/performance.md). jobs/tread_jobs/resources.py has the same figures for campaigns.
inline constexpr StepCost gpu_cost  = {2.0e-4, 3.4e-10, 5.0e-8, 1.5e-5, 3.5e-9};
inline constexpr StepCost core_cost = {2.0e-5, 4.5e-7, 1.0e-5, 0.0, 1.1e-6};

/// Predicted wall time of a whole run, s. Points and bodies are divided over `units` cores or GPUs.
double wall_time(const Estimate& wants, const world::World& world, const StepCost& cost, int units);

/// Formats a duration: "1:02:05"; from a year on "3e+05 years".
std::string duration_text(double seconds);

/// Number of cores of this machine.
int cores_here();

} // namespace tread::run
