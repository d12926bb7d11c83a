#include <utility>

#include "backend/instantiate.hpp"
#include "solver/bodies/body_reaches.hpp"
#include "solver/simulation.hpp"

// Sleep of sand, and of the rocks in it with their contacts.
namespace tread::solver
{

template<class Exec, class Real>
void Simulation<Exec, Real>::update_sleeping_pages(StageClock& clock)
{
    if (!sand_ || !measured()) { return; }
    const bool wakes = std::exchange(wakes_, false);
    if (!wakes && !sand_->sleep_is_due(measuring_.pace.largest_speed, damping_)) { return; }
    if (!wakes && sleep_follower().choose && !rigid_->has_list()) { return; }
    const auto update = [&]
    {
        std::vector<BodyReach> bodies;
        if (rigid_) { bodies = sand_wakers(); }
        const std::int64_t sorted = sand_->reorder_count();
        sand_->update_sleeping_pages(bodies, wakes ? 1.0 : damping_, sleep_follower());
        if (sand_->reorder_count() != sorted) { send_records(); }
    };
    clock.run(exec_, stage::sleep, update);
}

template<class Exec, class Real>
typename MpmSolver<Exec, Real>::SleepFollower Simulation<Exec, Real>::sleep_follower()
{
    if (!coupling_ || !rigid_->sleepers().strewn) { return {}; }
    const auto choose = [this](const contact::SandPages& pages)
    {
        contact::find_beds(exec_, rigid_->view(), rigid_->templates(), pages, scene_.grid.spacing,
                           rigid_->sleepers().next_bed.data());
        rigid_->follow_beds();
    };
    const auto move = [this](const SleepChange<Real>& change)
    {
        coupling_->follow_sleep(change, rigid_->view(), rigid_->sleepers());
        rigid_->renew_watches();
        if (rigid_->has_list()) { rigid_->hold_sleepers(); } // else the next list does
    };
    return {choose, move};
}

template<class Exec, class Real>
std::vector<BodyReach> Simulation<Exec, Real>::sand_wakers()
{
    const double edge = mpm::page_edge * scene_.grid.spacing;
    return bodies_that_wake_sand(exec_, rigid_->view(), rigid_->sleepers(), rigid_->bounding_radii(),
                                 {scene_.sleep.distance.value(), edge, scene_.sleep.rest, gravity_.norm()});
}

template<class Exec, class Real>
void Simulation<Exec, Real>::follow_owners()
{
    const std::int64_t moved = sand_->follow_owners();
    if (moved > 0 && sleep_follower().move) { coupling_->send_sleeping_after(sand_->migrated_out()); }
}

/// Sand beside a rock that has just woken is awake before the rock can move.
template<class Exec, class Real>
void Simulation<Exec, Real>::wake_sand_near_rocks(StageClock& clock)
{
    if (!std::exchange(rigid_->sleepers().woken, false) || !sand_ || !sand_->may_sleep()) { return; }
    clock.run(exec_, stage::sleep, [&] { sand_->wake_near(sand_wakers(), sleep_follower()); });
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void                                          Simulation<Exec, Real>::update_sleeping_pages(StageClock&); \
    template void                                          Simulation<Exec, Real>::wake_sand_near_rocks(StageClock&);  \
    template void                                          Simulation<Exec, Real>::follow_owners();                    \
    template typename MpmSolver<Exec, Real>::SleepFollower Simulation<Exec, Real>::sleep_follower();                   \
    template std::vector<BodyReach>                        Simulation<Exec, Real>::sand_wakers()
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
