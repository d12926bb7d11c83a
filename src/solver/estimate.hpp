#pragma once

#include <cstdint>
#include <string>

#include "solver/plan.hpp"

namespace tread::solver
{

/// What a run will want, from counts alone.
struct Estimate
{
    std::int64_t memory_bytes; ///< of the backend
    std::int64_t disk_bytes;   ///< snapshots and time series, at most
    double       time;         ///< s simulated, at most
    double       dt;           ///< s, at the start
    std::string  limit;        ///< what sets dt
    double       steps;        ///< at that dt, at most
};

Estimate estimate(const scene::Scene& scene, const World& world, const Plan& plan);

} // namespace tread::solver
