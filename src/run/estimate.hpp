#pragma once

#include <cstdint>
#include <string>

#include "solver/plan.hpp"

namespace tread::run
{

/// Upper bounds on the bytes of a run's files; values beyond 64 bits become the largest integer.
struct DiskUse
{
    std::int64_t snapshots;
    std::int64_t time_series;
    std::int64_t checkpoints; ///< all that are kept, and the one being written
    std::int64_t least;       ///< first snapshot and rows, which every run writes
    std::int64_t all;
};

/// Resources that a run will need, estimated from counts.
struct Estimate
{
    std::int64_t memory_bytes;   ///< memory of the backend
    std::int64_t copied_bytes;   ///< likewise, of what each of several ranks has whole: shapes
    double       bytes_a_point;  ///< memory of the sand, pages included; 0 without sand
    std::int64_t snapshot_bytes; ///< host memory while a snapshot is written asynchronously; 0 without
    DiskUse      disk;
    double       time;            ///< s simulated, at most
    double       dt;              ///< s, at the start
    std::string  limit;           ///< name of the bound that sets dt
    double       automatic;       ///< s, first step with "auto"
    double       hopeless;        ///< s, longer steps stop a run at once; infinite without sand
    double       resting_dt;      ///< s, once rocks lie on each other; dt without rocks
    double       substeps;        ///< number in each such step
    double       steps;           ///< number of these steps, at most
    double       resting_contact; ///< s, least sqrt(m / sum K) of rocks that lie on each other; 0 without
    double       node_pages;      ///< pages of grid nodes at the start
};

/// Memory of the backend that each of `ranks` needs, bytes.
std::int64_t memory_of_rank(const Estimate& wants, int ranks);

/// Throws EnvironmentError when a run that needs `wanted` bytes of "host" or "device" memory does not fit into `free`
/// even if the estimate is a tenth too high.
void require_room(const char* memory, std::int64_t wanted, std::int64_t free);

/// Throws EnvironmentError when `wanted` bytes exceed the `free` bytes of the directory's disk.
void require_disk(const std::string& directory, std::int64_t wanted, std::int64_t free);

/// s, sqrt(m / sum K) of a body that lies on others, C R sqrt(density / E): in settled piles of irregular rocks C is
/// 0.89 to 0.92 from 1e7 to 1e10 Pa, and with a tenth and ten times the linear_overlap 0.54 and 1.5 to 1.7
/// (docs/studies, "The substep that contacts allow"). Infinite for a rigid body.
double resting_contact(const scene::Scene& scene, const world::World& world, std::size_t body);

Estimate estimate(const scene::Scene& scene, const world::World& world, const solver::Plan& plan);

} // namespace tread::run
