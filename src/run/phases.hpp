#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scene/scene.hpp"

namespace tread::run
{

/// The running phase of a scene. Times in s of simulated time.
struct RunningPhase
{
    std::size_t         index = 0;
    double              start = 0;   ///< s
    std::vector<double> start_spins; ///< rad/s, of the named bodies about their axles at `start`
};

/// Tolerance (s) of comparisons with a time of the scene: covers the rounding of a sum of steps.
inline constexpr double time_rounding = 5e-10;

/// The first phase, at time 0 with all named bodies at rest.
RunningPhase first_phase(const scene::Scene& scene);

/// Enters the next phase at `time` (s); `spins`: rad/s, present angular velocities of the named bodies about their
/// axles.
void enter_next(RunningPhase& phase, double time, std::vector<double> spins);

/// Whether all phases of the scene have ended.
inline bool finished(const scene::Scene& scene, const RunningPhase& phase)
{
    return phase.index == scene.phases.size();
}

/// Keys of the running phase; not to be called when finished().
inline const scene::Phase& keys_of(const scene::Scene& scene, const RunningPhase& phase)
{
    return scene.phases[phase.index];
}

/// Latest simulated time (s) at which the running phase ends.
double latest_end(const scene::Scene& scene, const RunningPhase& phase);

/// Latest simulated time (s) at which the last phase ends.
double latest_end_of_run(const scene::Scene& scene, const RunningPhase& phase);

/// Index of the named body that the running phase lowers.
std::optional<std::size_t> lowered(const scene::Scene& scene, const RunningPhase& phase);

} // namespace tread::run
