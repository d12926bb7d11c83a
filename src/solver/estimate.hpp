#pragma once

#include <cstdint>
#include <string>

#include "solver/plan.hpp"

namespace tread::solver
{

/// What a run will want, from counts alone.
struct Estimate
{
    std::int64_t memory_bytes;  ///< of the backend
    double       bytes_a_point; ///< of the sand, pages included; 0 without sand
    std::int64_t disk_bytes;    ///< snapshots and time series, at most
    double       time;          ///< s simulated, at most
    double       dt;            ///< s, at the start
    std::string  limit;         ///< what sets dt
    double       resting_dt;    ///< s, once rocks lie on each other; dt without rocks
    double       substeps;      ///< of each such step
    double       steps;         ///< of these, at most
};

/// EnvironmentError when a run that wants `wanted` bytes of "host" or "device" memory does not fit into `free` even if
/// the estimate is a tenth too high.
void require_room(const char* memory, std::int64_t wanted, std::int64_t free);

Estimate estimate(const scene::Scene& scene, const World& world, const Plan& plan);

} // namespace tread::solver
