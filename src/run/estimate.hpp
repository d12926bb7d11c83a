#pragma once

#include <cstdint>
#include <string>

#include "solver/plan.hpp"

namespace tread::run
{

/// Bytes that a run's files come to, at most; what is beyond 64 bits is the largest integer.
struct DiskUse
{
    std::int64_t snapshots;
    std::int64_t time_series;
    std::int64_t checkpoints; ///< as many as are kept, and the one that is being written
    std::int64_t least;       ///< of the first snapshot and rows, which every run writes
    std::int64_t all;
};

/// What a run will want, from counts alone.
struct Estimate
{
    std::int64_t memory_bytes;   ///< of the backend
    double       bytes_a_point;  ///< of the sand, pages included; 0 without sand
    std::int64_t snapshot_bytes; ///< of the host, while one is written behind the computation; 0 without
    DiskUse      disk;
    double       time;       ///< s simulated, at most
    double       dt;         ///< s, at the start
    std::string  limit;      ///< what sets dt
    double       automatic;  ///< s, the step that "auto" begins with
    double       hopeless;   ///< s, longer steps stop a run at once; infinite without sand
    double       resting_dt; ///< s, once rocks lie on each other; dt without rocks
    double       substeps;   ///< of each such step
    double       steps;      ///< of these, at most
};

/// EnvironmentError when a run that wants `wanted` bytes of "host" or "device" memory does not fit into `free` even if
/// the estimate is a tenth too high.
void require_room(const char* memory, std::int64_t wanted, std::int64_t free);

/// EnvironmentError when `wanted` bytes do not fit where so many are free.
void require_disk(const std::string& directory, std::int64_t wanted, std::int64_t free);

Estimate estimate(const scene::Scene& scene, const world::World& world, const solver::Plan& plan);

} // namespace tread::run
