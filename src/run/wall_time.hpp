#pragma once

#include <string>

#include "run/workload.hpp"

namespace tread::run
{

/// Seconds that each count of a Workload takes, and the start of a run beside building its world. Names as there.
struct WorkCost
{
    double start; ///< s: device, memory, first launches

    // Not shared between cores or GPUs.
    double sand_steps;
    double searches;
    double substeps;
    double joint_substeps;
    double rows;

    // On one core or GPU.
    double points;
    double yielding_points;
    double pages;
    double bodies;
    double body_substeps;
    double near_substeps;
};

/// One H200 or H100, and one CPU core (docs/performance.md, "Wall time by model"). jobs/tread_jobs/resources.py has the
/// same figures for campaigns.
inline constexpr WorkCost gpu_cost  = {1.0,     9.0e-5,  2.0e-4, 7.0e-5, 8.0e-5, 8.0e-4,
                                       3.3e-10, 1.2e-11, 5.0e-9, 1.0e-8, 3.0e-9, 0.0};
inline constexpr WorkCost core_cost = {0.2,    2.0e-5, 3.0e-5, 2.5e-5, 1.0e-4, 1.0e-3,
                                       2.3e-7, 1.1e-7, 5.5e-6, 3.0e-6, 8.0e-7, 2.0e-7};

/// What a run is expected to take.
struct Expected
{
    double   set_up; ///< s, wall time in which this process has built the world
    double   time;   ///< s, simulated
    Workload work;
};

/// Predicted wall time of a run once its world is built, s. Points, pages and bodies are divided over `units` cores or
/// GPUs.
double wall_time(const Workload& work, const WorkCost& cost, int units);

/// Formats a duration: "1:02:05"; from a year on "3e+05 years".
std::string duration_text(double seconds);

/// Number of cores of this machine.
int cores_here();

} // namespace tread::run
