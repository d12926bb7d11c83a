#pragma once

#include <optional>
#include <string>
#include <vector>

#include "run/phases.hpp"
#include "solver/bodies/body_command.hpp"
#include "solver/bodies/body_row.hpp"
#include "world/world.hpp"

// Prescribed motions of the running phase: what bodies are commanded to, and the stops that end the phase.
namespace tread::solver
{
class StateFile;
}

namespace tread::run
{

/// A named body when the running phase began; vectors in the world frame.
struct BodyStart
{
    Vec3<double> position;         ///< m
    Quat         orientation;      ///< body to world
    Vec3<double> velocity;         ///< m/s
    Vec3<double> angular_velocity; ///< rad/s
};

/// Contact force on a body: an exponential mean, as CarriedShare.
struct ContactForce
{
    /// Adds the impulse (N s) of the contacts until `time` (s), counted from any start.
    void note(double time, const Vec3<double>& total);

    double       last    = -1;                   ///< s, time of the last note(); negative = never
    Vec3<double> impulse = Vec3<double>::Zero(); ///< N s, at that time
    Vec3<double> mean    = Vec3<double>::Zero(); ///< N
};

/// What the motions of the running phase are based on, for each named body.
struct MotionState
{
    std::vector<double>       mass; ///< kg
    std::vector<BodyStart>    start;
    std::vector<ContactForce> contact; ///< since the phase began; of bodies with stops
};

/// State for the first phase.
MotionState first_motions(const scene::Scene& scene, const world::World& world);

/// Begins a phase with bodies as in `rows`. A body that is released for the first time has the scene's velocity.
void begin_motions(MotionState& state, const scene::Scene& scene, std::size_t phase,
                   const std::vector<solver::BodyRow>& rows);

/// Directions of the axes of a motion of a body, as columns.
Mat3<double> axes_of(scene::MotionFrame frame, const BodyStart& start);

/// Throws NumericalError, with `time` (s), if a motion of the running phase holds the axle and axes that lie in one
/// plane with it.
void require_independent_axes(const scene::Scene& scene, const RunningPhase& phase, const MotionState& state,
                              double time);

/// A step, counted from the beginning of its phase.
struct StepOfPhase
{
    double end; ///< s
    double dt;  ///< s
};

/// What a motion prescribes in a step: velocities of its end, mean forces of it. `gravity`: m/s2; `mass`: kg.
dem::Prescribed prescribed_in(const scene::Motion& motion, const scene::Body& body, const BodyStart& start, double mass,
                              const Vec3<double>& gravity, const StepOfPhase& step);

/// Sets the commands of bodies with a motion in the running phase, for a step of `dt` (s) that ends at `time` (s).
void add_motions(std::vector<solver::BodyCommand>& commands, const scene::Scene& scene, const RunningPhase& phase,
                 const MotionState& state, double time, double dt);

/// Whether a motion of the phase has stops.
bool has_stops(const scene::Phase& phase);

/// The stop that a body has reached: "force_z = 201 N". `moved`: m, since the phase began.
std::optional<std::string> stop_reached(const scene::Motion& motion, const Mat3<double>& frame,
                                        const Vec3<double>& moved, const Vec3<double>& force);

/// Turns reactions into the frames of the phase's motions; those of bodies without one are not numbers.
void turn_reactions(std::vector<solver::BodyRow>& rows, const scene::Scene& scene, const RunningPhase& phase,
                    const MotionState& state);

/// Saves to a checkpoint, or loads from it; nothing in scenes without motions.
void transfer(solver::StateFile& file, const scene::Scene& scene, MotionState& state);

} // namespace tread::run
