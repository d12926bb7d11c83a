#pragma once

#include <vector>

#include "run/drive_room.hpp"
#include "run/estimate.hpp"
#include "solver/plan.hpp"
#include "world/world.hpp"

namespace tread::run
{

/// Counts in which the wall time of a run is linear (wall_time.hpp).
struct Workload
{
    double sand_steps;      ///< steps of a scene with sand
    double searches;        ///< steps that measure and, with bodies, search their contacts
    double substeps;        ///< of bodies; at least one a step
    double joint_substeps;  ///< substeps of a scene with joints
    double rows;            ///< of the time series' tables: one, and one for each named body
    double points;          ///< steps of all points
    double yielding_points; ///< the same, of sand whose law yields
    double pages;           ///< steps of all node pages
    double bodies;          ///< searches of all bodies
    double body_substeps;   ///< substeps of all bodies
    double near_substeps;   ///< substeps of the points next to rocks
};

/// What is expected of a phase.
struct PhasePace
{
    double time;     ///< s, simulated
    double dt;       ///< s
    double substeps; ///< of a step
    double searches; ///< a step
};

/// Expects of every phase how long it lasts and which steps it takes. A phase that ends by itself: equilibrium of sand
/// alone after the time for which it must hold, with rocks halfway between that and max_duration (assumed); lowering
/// when the body has sunk as far as at rest; a drive at the end of the bed, a motion at a displacement that ends it.
std::vector<PhasePace> expected_phases(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
                                       const Estimate& wants, const std::vector<DriveRoom>& rooms);

/// The phases as one that takes as long as they may, in steps of rocks at rest.
inline PhasePace longest_pace(const Estimate& wants) { return {wants.time, wants.resting_dt, wants.substeps, 1}; }

/// Adds up the work of phases.
Workload workload(const scene::Scene& scene, const world::World& world, const solver::Plan& plan, const Estimate& wants,
                  const std::vector<PhasePace>& phases);

} // namespace tread::run
