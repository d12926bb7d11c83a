#include <utility>

#include "backend/instantiate.hpp"
#include "solver/bodies/body_reaches.hpp"
#include "solver/simulation.hpp"

// Sleep of sand, with its contacts with sleeping rocks.
namespace tread::solver
{

template<class Exec, class Real>
void Simulation<Exec, Real>::update_sleeping_pages(StageClock& clock)
{
    if (!sand_ || !measured()) { return; }
    const bool wakes = std::exchange(wakes_, false);
    if (!wakes && !sand_->sleep_is_due(measuring_.pace.largest_speed, damping_)) { return; }
    const auto update = [&]
    {
        std::vector<BodyReach> bodies;
        if (rigid_) { bodies = awake_reaches(exec_, rigid_->view(), world_); }
        sand_->update_sleeping_pages(bodies, wakes ? 1.0 : damping_, sleep_follower());
    };
    clock.run(exec_, stage::sleep, update);
}

template<class Exec, class Real>
typename MpmSolver<Exec, Real>::FollowSleep Simulation<Exec, Real>::sleep_follower()
{
    if (!coupling_ || rigid_->sleepers().sand.size() == 0) { return {}; }
    return [this](const SleepChange<Real>& change)
    {
        coupling_->follow_sleep(change, rigid_->view(), rigid_->sleepers());
        rigid_->hold_sleepers();
    };
}

/// Sand beside a rock that has just woken is awake before the rock can move.
template<class Exec, class Real>
void Simulation<Exec, Real>::wake_sand_near_rocks(StageClock& clock)
{
    if (!std::exchange(rigid_->sleepers().woken, false) || !sand_ || sand_->asleep() == 0) { return; }
    clock.run(exec_, stage::sleep,
              [&] { sand_->wake_near(awake_reaches(exec_, rigid_->view(), world_), sleep_follower()); });
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void                                        Simulation<Exec, Real>::update_sleeping_pages(StageClock&);   \
    template void                                        Simulation<Exec, Real>::wake_sand_near_rocks(StageClock&);    \
    template typename MpmSolver<Exec, Real>::FollowSleep Simulation<Exec, Real>::sleep_follower()
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
