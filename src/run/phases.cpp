#include "run/phases.hpp"

#include <algorithm>
#include <utility>

namespace tread::run
{

RunningPhase first_phase(const scene::Scene& scene) { return {0, 0, std::vector<double>(scene.bodies.size(), 0.0)}; }

void enter_next(RunningPhase& phase, double time, std::vector<double> spins)
{
    phase = {phase.index + 1, time, std::move(spins)};
}

double latest_end(const scene::Scene& scene, const RunningPhase& phase)
{
    return phase.start + scene::time_limit(keys_of(scene, phase));
}

double latest_end_of_run(const scene::Scene& scene, const RunningPhase& phase)
{
    double end = latest_end(scene, phase);
    for (std::size_t p = phase.index + 1; p < scene.phases.size(); ++p) { end += scene::time_limit(scene.phases[p]); }
    return end;
}

std::optional<std::size_t> lowered(const scene::Scene& scene, const RunningPhase& phase)
{
    const auto& lower = keys_of(scene, phase).lower;
    if (!lower) { return {}; }
    const auto at = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                 [&](const scene::Body& body) { return body.name == lower->body; });
    return static_cast<std::size_t>(at - scene.bodies.begin());
}

} // namespace tread::run
