#include <algorithm>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "solver/simulation.hpp"

// The contact substeps of a step.
namespace tread::solver
{
namespace
{

/// Substeps between checks for a stop request; more than a usual step has.
constexpr std::int64_t substeps_between_checks = 1000;

} // namespace

template<class Exec, class Real>
void Simulation<Exec, Real>::substeps(const TimeStep& step, double time, StageClock& clock)
{
    const double dt    = step.dt / static_cast<double>(step.substeps);
    const auto   batch = plan_.body_contact
                             ? rigid_->substeps_without_check(step, pace_.largest_speed, pace_.shortest_contact)
                             : step.substeps;
    for (std::int64_t done = 0; done < step.substeps; done += batch)
    {
        const std::int64_t next = std::min(step.substeps - done, batch);
        if (done > 0)
        {
            clock.run(exec_, stage::pairs, [&] { rigid_->find_pairs_if_displaced(step, batch, done, time); });
        }
        run_batch(dt, done, next, clock);
    }
}

/// Runs `count` substeps after `done` others of the step, with checks for a stop request in between.
template<class Exec, class Real>
void Simulation<Exec, Real>::run_batch(double dt, std::int64_t done, std::int64_t count, StageClock& clock)
{
    for (const std::int64_t end = done + count; done < end;)
    {
        const std::int64_t check = (done / substeps_between_checks + 1) * substeps_between_checks;
        const std::int64_t next  = std::min(check, end);
        run_substeps(dt, next - done, clock);
        done = next;
        if (done == check) { check_for_stop(); }
    }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::run_substeps(double dt, std::int64_t count, StageClock& clock)
{
    if (plan_.body_contact && !coupling_)
    {
        clock.run(exec_, stage::body_contact, [&] { rigid_->run(dt, damping_, count); });
    }
    else if (!in_one_launch(dt, count, clock))
    {
        for (std::int64_t substep = 0; substep < count; ++substep) { coupled_substep(dt, clock); }
    }
}

/// Synchronises first: launches are asynchronous, and no time would pass between two checks.
template<class Exec, class Real>
void Simulation<Exec, Real>::check_for_stop()
{
    if (!why_stop_) { return; }
    synchronize(exec_);
    if (const auto why = why_stop_()) { throw StoppedInStep(*why); }
}

/// Runs sand-body and body-body substeps in one launch where that is worthwhile; the time counts as sand-body contact.
template<class Exec, class Real>
bool Simulation<Exec, Real>::in_one_launch(double dt, std::int64_t count, StageClock& clock)
{
    if (!coupling_ || rigid_->shares()) { return false; }
    const dem::BodyStep<Exec> step = rigid_->body_step(dt, damping_);
    if (!coupling_->worth_one_launch(step)) { return false; }
    clock.run(exec_, stage::sand_contact, [&] { coupling_->run_substeps(step, count); });
    rigid_->count_substeps(dt, count);
    return true;
}

template<class Exec, class Real>
void Simulation<Exec, Real>::coupled_substep(double dt, StageClock& clock)
{
    if (coupling_)
    {
        clock.run(exec_, stage::sand_contact, [&] { coupling_->substep(rigid_->view(), dt); });
    }
    if (plan_.body_contact)
    {
        clock.run(exec_, stage::body_contact, [&] { rigid_->contact(dt); });
    }
    clock.run(exec_, stage::integrate,
              [&] { rigid_->move(dt, damping_, coupling_ ? coupling_->wrenches() : dem::OutsideWrenches{}); });
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void Simulation<Exec, Real>::substeps(const TimeStep&, double, StageClock&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
