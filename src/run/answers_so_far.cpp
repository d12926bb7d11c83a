#include "run/answers_so_far.hpp"

#include <cmath>

#include "scene/named.hpp"

namespace tread::run
{

void AnswersSoFar::add(const scene::Scene& scene, const RunningPhase& running, double time,
                       const std::vector<solver::BodyRow>& bodies)
{
    const double before = last_row;
    if (running.index != phase) { *this = AnswersSoFar{running.index}; }
    last_row = time;
    if (finished(scene, running)) { return; }
    const scene::Phase& keys = keys_of(scene, running);
    if (keys.lower)
    {
        const solver::BodyRow& body = bodies[scene::index_of(scene.bodies, keys.lower->body)];
        sinkage                     = body.surface - body.lowest;
    }
    if (!keys.drive) { return; }
    const solver::BodyRow& body = bodies[scene::index_of(scene.bodies, keys.drive->body)];
    sinkage                     = body.surface - body.lowest;
    if (before < running.start + keys.drive->ramp - time_rounding) { return; }
    span += time - before;
    impulse += (time - before) * std::copysign(1.0, keys.drive->angular_velocity) * body.force[0];
}

std::optional<double> AnswersSoFar::pull() const
{
    return span > 0 ? std::optional<double>(impulse / span) : std::nullopt;
}

} // namespace tread::run
