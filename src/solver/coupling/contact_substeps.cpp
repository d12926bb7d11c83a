#include "solver/coupling/contact_substeps.hpp"

#include <algorithm>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"

namespace tread::solver
{
namespace
{

/// Substeps between checks for a stop request; more than a usual step has.
constexpr std::int64_t substeps_between_checks = 1000;

template<class Exec, class Real>
void coupled_substep(const ContactSubsteps<Exec, Real>& parts, double dt, StageClock& clock)
{
    if (parts.coupling != nullptr)
    {
        clock.run(parts.exec, stage::sand_contact,
                  [&] { parts.coupling->substep(parts.bodies.substep_exec(), parts.bodies.view(), dt); });
    }
    if (parts.plan.body_contact)
    {
        clock.run(parts.exec, stage::body_contact, [&] { parts.bodies.contact(dt); });
    }
    const auto move = [&]
    {
        parts.bodies.move(dt, parts.damping,
                          parts.coupling != nullptr ? parts.coupling->wrenches() : dem::OutsideWrenches{});
    };
    clock.run(parts.exec, stage::integrate, move);
}

/// Runs sand-body and body-body substeps in one launch where that is worthwhile; the time counts as sand-body contact.
template<class Exec, class Real>
bool run_in_one_launch(const ContactSubsteps<Exec, Real>& parts, double dt, std::int64_t count, StageClock& clock)
{
    if (parts.coupling == nullptr || parts.bodies.shares()) { return false; }
    const dem::BodyStep<Exec> step = parts.bodies.body_step(dt, parts.damping);
    if (!parts.coupling->worth_one_launch(step)) { return false; }
    clock.run(parts.exec, stage::sand_contact, [&] { parts.coupling->run_substeps(step, count); });
    parts.bodies.requested(count);
    return true;
}

template<class Exec, class Real>
void run_together(const ContactSubsteps<Exec, Real>& parts, double dt, std::int64_t count, StageClock& clock)
{
    if (parts.plan.body_contact && parts.coupling == nullptr)
    {
        clock.run(parts.exec, stage::body_contact, [&] { parts.bodies.run(dt, parts.damping, count); });
    }
    else if (!run_in_one_launch(parts, dt, count, clock))
    {
        for (std::int64_t substep = 0; substep < count; ++substep) { coupled_substep(parts, dt, clock); }
    }
}

/// Requests `count` substeps; those after the last that the list of pairs serves do nothing, on all ranks.
template<class Exec, class Real>
void run_unchecked(const ContactSubsteps<Exec, Real>& parts, double dt, std::int64_t count, StageClock& clock)
{
    for (std::int64_t requested = 0; requested < count;)
    {
        const std::int64_t next = std::min(count - requested, parts.bodies.until_agreement());
        run_together(parts, dt, next, clock);
        requested += next;
        if (!parts.bodies.must_agree()) { continue; }
        clock.run(parts.exec, stage::pairs, [&] { parts.bodies.agree_on_list(); });
    }
}

/// Call when the list of pairs was rebuilt within a step.
template<class Exec, class Real>
void follow_rows(const ContactSubsteps<Exec, Real>& parts)
{
    if (parts.coupling == nullptr) { return; }
    const RowMoves<Exec>* moves = parts.bodies.row_moves();
    if (moves != nullptr) { parts.coupling->follow_rows(moves->to, parts.bodies.view()); }
    follow_sleepers(parts.bodies, *parts.coupling);
}

/// Synchronises first: launches are asynchronous, and no time would pass between two checks.
template<class Exec, class Real>
void check_stop(const ContactSubsteps<Exec, Real>& parts)
{
    if (!parts.why_stop) { return; }
    synchronize(parts.exec);
    if (const auto why = parts.why_stop()) { throw StoppedInStep(*why); }
}

/// Runs up to `count` substeps after `done` others of the step, until the list of pairs expires or a check for a stop
/// request is due; returns how many.
template<class Exec, class Real>
std::int64_t run_batch(const ContactSubsteps<Exec, Real>& parts, double dt, std::int64_t done, std::int64_t count,
                       StageClock& clock)
{
    const std::int64_t check = (done / substeps_between_checks + 1) * substeps_between_checks;
    run_unchecked(parts, dt, std::min(check - done, count), clock);
    const std::int64_t ran = parts.bodies.take_done(dt);
    if (done + ran == check) { check_stop(parts); }
    return ran;
}

} // namespace

template<class Exec, class Real>
void follow_sleepers(DemSolver<Exec>& bodies, SandBodyCoupling<Exec, Real>& coupling)
{
    dem::SleepingBodies<Exec>& sleepers = bodies.sleepers();
    if (!sleepers.strewn || !sleepers.ranks) { return; }
    coupling.sum_asleep(bodies.view(), sleepers);
    bodies.hold_sleepers();
}

template<class Exec, class Real>
void run_substeps(const ContactSubsteps<Exec, Real>& parts, const TimeStep& step, double time, const Pace& pace,
                  StageClock& clock)
{
    const double dt         = step.dt / static_cast<double>(step.substeps);
    const auto   list_moved = [&]
    {
        if (parts.coupling != nullptr) { parts.bodies.list_moved(parts.coupling->wrenches()); }
    };
    if (parts.plan.body_contact) { parts.bodies.begin_substeps(step, pace.largest_speed, pace.shortest_contact); }
    list_moved();
    for (std::int64_t done = 0; done < step.substeps;)
    {
        if (done > 0)
        {
            clock.run(parts.exec, stage::pairs,
                      [&]
                      {
                          if (!parts.bodies.find_pairs_if_displaced(step, done, time)) { return; }
                          follow_rows(parts);
                          list_moved();
                      });
        }
        done += run_batch(parts, dt, done, step.substeps - done, clock);
    }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void follow_sleepers(DemSolver<Exec>&, SandBodyCoupling<Exec, Real>&);                                    \
    template void run_substeps(const ContactSubsteps<Exec, Real>&, const TimeStep&, double, const Pace&, StageClock&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
