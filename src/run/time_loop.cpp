#include "run/time_loop.hpp"

#include <algorithm>
#include <utility>

#include "backend/instantiate.hpp"
#include "scene/named.hpp"

namespace tread::run
{
namespace
{

/// Calls `f` if it is not empty.
template<class F, class... Arguments>
void call(const F& f, Arguments&&... arguments)
{
    if (f) { f(std::forward<Arguments>(arguments)...); }
}

bool ends_early(PhaseEndWatch& watch, const LoopCalls& calls)
{
    const std::optional<PhaseEnd> early = calls.early_end ? calls.early_end() : std::nullopt;
    if (early) { watch.ending = *early; }
    return early.has_value();
}

/// Whether a body has reached a stop of the running phase; then sets watch.ending.
template<class Exec, class Real>
bool ends_by_stop(TimeLoop<Exec, Real>& loop)
{
    PhaseEnd& end = loop.watch.ending;
    if (!loop.simulation.measured()) { return false; }
    for (const scene::Motion& motion : keys_of(loop.scene, loop.phase).motion)
    {
        if (!motion.until) { continue; }
        const std::size_t b = scene::index_of(loop.scene.bodies, motion.body);
        loop.motions.contact[b].note(loop.progress.time, loop.simulation.contact_impulse(b));
        const BodyStart&   start = loop.motions.start[b];
        const Vec3<double> moved = loop.simulation.place(b) - start.position;
        const auto stop = stop_reached(motion, axes_of(motion.frame, start), moved, loop.motions.contact[b].mean);
        if (!stop) { continue; }
        end.kind  = EndKind::stopped;
        end.body  = motion.body;
        end.place = *stop;
        return true;
    }
    return false;
}

template<class Exec, class Real>
bool phase_is_over(TimeLoop<Exec, Real>& loop, const LoopCalls& calls)
{
    const double time = loop.progress.time;
    if (const auto body = lowered(loop.scene, loop.phase); body && loop.simulation.measured())
    {
        loop.watch.carried.note(time, loop.simulation.carried(*body));
    }
    const bool over = ends_early(loop.watch, calls) ||
                      is_over(loop.scene, loop.phase, loop.watch, time, loop.simulation.unbalanced());
    if (!has_stops(keys_of(loop.scene, loop.phase))) { return over; }
    if (over && loop.watch.ending.kind == EndKind::duration) { loop.watch.ending.kind = EndKind::unstopped; }
    return ends_by_stop(loop) || over;
}

/// Angular velocities (rad/s) of the named bodies about their axles.
std::vector<double> axle_spins(const std::vector<solver::BodyRow>& bodies)
{
    std::vector<double> spins(bodies.size());
    std::transform(bodies.begin(), bodies.end(), spins.begin(), solver::spin_of);
    return spins;
}

} // namespace

template<class Exec, class Real>
TimeLoop<Exec, Real>::TimeLoop(const scene::Scene& run_scene, const world::World& world,
                               solver::Simulation<Exec, Real>& run_simulation)
    : scene(run_scene)
    , simulation(run_simulation)
    , rolling_radii(tread::run::rolling_radii(run_scene, world))
    , phase(first_phase(run_scene))
    , motions(first_motions(run_scene, world))
{
}

template<class Exec, class Real>
solver::TimeStep take_step(TimeLoop<Exec, Real>& loop, const LoopCalls& calls)
{
    auto&        simulation = loop.simulation;
    RunProgress& progress   = loop.progress;
    if (simulation.measured())
    {
        progress.chosen =
            solver::choose_step(loop.scene.time, simulation.limits(), simulation.pace(), progress.chosen.dt);
    }
    solver::TimeStep step = progress.chosen;
    const double     left = latest_end(loop.scene, loop.phase) - progress.time;
    if (left > 0) { step.dt = solver::fitted(step.dt, left); }
    call(calls.before_step, step);

    set_commands(loop.commands, loop.scene, loop.phase, loop.rolling_radii, progress.time + step.dt);
    add_motions(loop.commands, loop.scene, loop.phase, loop.motions, progress.time + step.dt, step.dt);
    call(calls.adjust, loop.commands);
    simulation.begin_phase(loop.phase.index);
    simulation.command(loop.commands, keys_of(loop.scene, loop.phase).damping);
    step = simulation.step(step, progress.time, loop.clock);
    progress.time += step.dt;
    ++progress.steps;
    progress.substeps += step.substeps;
    progress.last_dt = step.dt;
    return step;
}

template<class Exec, class Real>
void end_phases(TimeLoop<Exec, Real>& loop, const LoopCalls& calls)
{
    bool over = phase_is_over(loop, calls);
    while (over)
    {
        call(calls.phase_ends);
        PhaseEnd                           ended  = loop.watch.ending;
        const std::vector<solver::BodyRow> bodies = loop.simulation.named_bodies();
        enter_next(loop.phase, loop.progress.time, axle_spins(bodies));
        loop.watch        = PhaseEndWatch{};
        loop.watch.ending = std::move(ended);
        if (finished(loop.scene, loop.phase)) { return; }
        begin_motions(loop.motions, loop.scene, loop.phase.index, bodies);
        call(calls.phase_begins);
        over = ends_early(loop.watch, calls);
    }
}

template<class Exec, class Real>
std::optional<std::string> run_phases(TimeLoop<Exec, Real>& loop, const LoopCalls& calls)
{
    while (!finished(loop.scene, loop.phase))
    {
        if (auto reason = calls.reason_to_stop ? calls.reason_to_stop() : std::nullopt) { return reason; }
        take_step(loop, calls);
        call(calls.after_step);
        end_phases(loop, calls);
    }
    return {};
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template struct TimeLoop<Exec, Real>;                                                                              \
    template solver::TimeStep           take_step(TimeLoop<Exec, Real>&, const LoopCalls&);                            \
    template void                       end_phases(TimeLoop<Exec, Real>&, const LoopCalls&);                           \
    template std::optional<std::string> run_phases(TimeLoop<Exec, Real>&, const LoopCalls&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::run
