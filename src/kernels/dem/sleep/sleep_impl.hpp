#pragma once

#include "backend/instantiate.hpp"
#include "kernels/dem/contact/body_contact.hpp"
#include "kernels/dem/pairs/records_kern.hpp"
#include "kernels/dem/sleep/held_kern.hpp"
#include "kernels/dem/sleep/sleep_kern.hpp"
#include "kernels/dem/sleep/sleeping_pairs_impl.hpp"

// Steps of sleep.hpp, for both backends; sleep.cpp and sleep.cu provide for_each.
namespace tread::dem::sleeping
{

/// Gives each body that several ranks hold the largest of their marks.
template<class Exec>
void agree_on(const Exec& exec, SleepingBodies<Exec>& sleep, Array<Exec, std::int32_t>& mark)
{
    if (!sleep.ranks) { return; }
    const SharedView shared = sleep.ranks->shared();
    for_each(exec, "share sleep marks", shared.count, ShareMark{shared, mark.data()});
    sleep.ranks->exchange_marks();
    for_each(exec, "take sleep marks", shared.count, TakeMark{shared, mark.data()});
}

/// Exchanges the shares of a sum over the contacts of shared bodies.
template<class Exec, class Sum>
void share_sums(const Exec& exec, SleepingBodies<Exec>& sleep, const char* name, const Sum& sum)
{
    if (!sleep.ranks) { return; }
    const SharedView shared = sleep.ranks->shared();
    for_each(exec, name, shared.count, ShareSum<Sum>{shared, sum});
    sleep.ranks->exchange_wrenches();
}

/// Sums rows of doubles in pairs.measure, one a body, over this rank's bodies. Sums: a struct of doubles.
template<class Sums, class Exec, class WriteRow>
Sums sum_over_bodies(const Exec& exec, Pairs<Exec>& pairs, std::int64_t bodies, const char* name, WriteRow write_row)
{
    constexpr int width = sizeof(Sums) / sizeof(double);
    pairs.measure.resize(width * bodies + width);
    double* rows = pairs.measure.data();
    for_each(exec, name, bodies, write_row(rows));
    sum_rows(exec, rows, bodies, width, rows + width * bodies);
    return read(exec, reinterpret_cast<const Sums*>(rows + width * bodies));
}

/// Counts the marks of all ranks' bodies.
template<class Exec>
SleepCount count_marks(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    const SleepingBodies<Exec>& sleep = pairs.sleep;
    const auto count = [&](double* rows) { return CountMark{bodies, sleep.rule.first, sleep.mark.data(), rows}; };
    auto       all   = sum_over_bodies<SleepCount>(exec, pairs, bodies.count, "count sleep marks", count);
    sleep.add_ranks(all);
    return all;
}

/// Sums number and mass of what sleeps on all ranks, and contact energy of what sleeps here.
template<class Exec>
void weigh(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    SleepingBodies<Exec>& sleep = pairs.sleep;
    const std::int64_t    count = sleep.pairs.key.size();
    const auto            write = [&](double* rows) { return WriteSleeper{bodies, rows}; };
    auto                  sum   = sum_over_bodies<SleepersSum>(exec, pairs, bodies.count, "weigh sleepers", write);
    sleep.here                  = sum.count;
    sleep.add_ranks(sum);
    sleep.count = sum.count;
    sleep.mass  = sum.mass;
    pairs.measure.resize(count + 1);
    double* rows = pairs.measure.data();
    for_each(exec, "energies of sleepers", count, WriteEnergy{sleep.pairs.view(), rows});
    sum_rows(exec, rows, count, 1, rows + count);
    sleep.energy = read(exec, rows + count);
}

} // namespace tread::dem::sleeping

namespace tread::dem
{

template<class Exec>
void begin_sleep(const Exec& exec, Pairs<Exec>& pairs, Bodies<Exec>& bodies, const BodyRestRule& rule)
{
    SleepingBodies<Exec>& sleep = pairs.sleep;
    const std::int64_t    count = bodies.position.size();
    sleep.wanted                = true;
    sleep.rule                  = rule;
    const auto at_zero          = [&](auto&... arrays) { ((arrays.resize(count), arrays.fill_zero()), ...); };
    at_zero(bodies.asleep, sleep.quiet, sleep.moves, sleep.mark, sleep.watch);
    sleep.resize_sand(count);
    sleep.position.resize(count);
    sleep.orientation.resize(count);
    copy(exec, sleep.position.data(), bodies.position.data(), static_cast<std::size_t>(count) * sizeof(Vec3<double>));
    copy(exec, sleep.orientation.data(), bodies.orientation.data(), static_cast<std::size_t>(count) * sizeof(Quat));
}

template<class Exec>
SleepCount look_at_sleep(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    using namespace sleeping;
    SleepingBodies<Exec>& sleep = pairs.sleep;
    SleepClock&           clock = sleep.clock;
    const bool            ends  = clock.window >= sleep.rule.rest;
    for_each(exec, "time at rest", bodies.count,
             WatchRest{bodies, law.templates, sleep.rule, clock.look, sleep.rest_watch()});
    for_each(exec, "look at sleep", bodies.count,
             LookAtBody{bodies, law.templates, pairs.view(), sleep.rule, ends ? clock.window : 0.0, clock.held,
                        sleep.rest_watch(), sleep.bed.data(), sleep.watch.data(), sleep.mark.data()});
    agree_on(exec, sleep, sleep.mark);
    clock.look = 0;
    if (ends) { clock.window = clock.held = 0; }
    return count_marks(exec, pairs, bodies);
}

template<class Exec>
SleepCount follow_beds(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    SleepingBodies<Exec>& sleep = pairs.sleep;
    for_each(exec, "follow beds", bodies.count,
             sleeping::FollowBed{bodies, sleep.rule, sleep.quiet.data(), sleep.next_bed.data(), sleep.bed.data(),
                                 sleep.mark.data()});
    const SleepCount count = sleeping::count_marks(exec, pairs, bodies);
    if (count.wake > 0) { sleep.change = true; }
    return count;
}

template<class Exec>
void renew_watches(const Exec& exec, Pairs<Exec>& pairs)
{
    SleepingBodies<Exec>& sleep = pairs.sleep;
    sleeping::agree_on(exec, sleep, sleep.loaded);
    for_each(exec, "renew watches", sleep.loaded.size(), sleeping::RenewWatch{sleep.loaded.data(), sleep.watch.data()});
}

template<class Exec>
void fall_asleep(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, BodyTotal* totals,
                 double substep, const Vec3<double>& gravity)
{
    using namespace sleeping;
    SleepingBodies<Exec>& sleep = pairs.sleep;
    for_each(exec, "stop bodies", bodies.count, StopBody{bodies, sleep.mark.data(), totals, substep, gravity});
    stage_bodies(exec, pairs, bodies);
    evaluate_contacts(exec, pairs, bodies, law, 0);
    for_each(exec, "friction at rest", bodies.count, BookFriction{bodies.count, pairs.view(), totals});
    const SumLoads loads{pairs.view()};
    share_sums(exec, sleep, "share loads", loads);
    for_each(
        exec, "begin watch", bodies.count,
        BeginWatch{bodies, loads, sleep.shared(), sleep.rule.load, gravity, sleep.watch.data(), sleep.mark.data()});
    keep_contacts(exec, pairs, bodies);
    sleep.change = true;
}

template<class Exec>
void wake_all(Pairs<Exec>& pairs, Bodies<Exec>& bodies)
{
    bodies.asleep.fill_zero();
    pairs.sleep.quiet.fill_zero();
    pairs.sleep.moves.fill_zero();
    pairs.sleep.mark.fill_zero();
    if (pairs.sleep.count > 0) { pairs.sleep.change = pairs.sleep.woken = true; }
}

template<class Exec>
void wake_bodies(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double cell_size)
{
    using namespace sleeping;
    SleepingBodies<Exec>& sleep = pairs.sleep;
    if (sleep.count == 0 && !sleep.change) { return; }
    if (sleep.change) { order_contacts(exec, pairs, bodies); }
    const PairSearch search = pair_steps::make_search(pairs, bodies, law, cell_size);
    for_each(exec, "mark sleepers near", search.part_count(), MarkNear{search, sleep.moves.data(), sleep.mark.data()});
    agree_on(exec, sleep, sleep.mark);
    for (int ring = 0; ring < waking_rings; ++ring)
    {
        for_each(exec, "widen waking", bodies.count,
                 WidenMarks{bodies, sleep.pairs.view(), mark_wakes + ring, sleep.mark.data()});
        agree_on(exec, sleep, sleep.mark);
    }
    const auto wake = [&](double* rows)
    { return WakeBody{bodies, sleep.rule, sleep.bed.data(), sleep.mark.data(), sleep.rest_watch(), rows}; };
    auto woken = sum_over_bodies<Woken>(exec, pairs, bodies.count, "wake bodies", wake);
    sleep.add_ranks(woken);
    sleep.change = sleep.change || woken.bodies > 0;
    sleep.woken  = sleep.woken || woken.in_sand > 0;
}

template<class Exec>
void settle_sleepers(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    using namespace sleeping;
    SleepingBodies<Exec>& sleep = pairs.sleep;
    if (sleep.change)
    {
        drop_contacts(exec, pairs, bodies);
        order_contacts(exec, pairs, bodies);
        hold_sleepers(exec, pairs, bodies);
        weigh(exec, pairs, bodies);
        sleep.change = false;
    }
    list_moved_bodies(exec, pairs, bodies, {});
}

template<class Exec>
void hold_sleepers(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    SleepingBodies<Exec>&   sleep = pairs.sleep;
    const sleeping::SumHeld all{bodies, sleep.pairs.view(), sleep.sand.data()};
    sleeping::share_sums(exec, sleep, "share what holds bodies", all);
    for_each(exec, "hold bodies", bodies.count,
             sleeping::HoldBody{bodies, all, sleep.shared(), sleep.clock.held, sleep.watch.data()});
    sleep.clock.held = 0;
}

template<class Exec>
void resume_sleep(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    sleeping::order_contacts(exec, pairs, bodies);
    sleeping::weigh(exec, pairs, bodies);
    pairs.sleep.change = false;
    if (pairs.of_body.first.size() > 0) { list_moved_bodies(exec, pairs, bodies, {}); }
}

template<class Exec>
void renumber_sleeping_pairs(const Exec& exec, Pairs<Exec>& pairs, const Array<Exec, std::int32_t>& row,
                             std::int64_t rows)
{
    using namespace record_steps;
    SleepingPairs<Exec>&      kept = pairs.sleep.pairs;
    const NewRows             now{row.size(), rows, row.data()};
    Array<Exec, std::int32_t> left(exec, "sleeping pairs left");
    select(exec, "sleeping pairs left", kept.key.size(), IsLeft{now, kept.key.data()}, pairs.search.found, pairs.sort,
           left);
    if (left.size() < kept.key.size()) { sleeping::take_rows(exec, pairs, left); }
    for_each(exec, "renumber sleeping pairs", left.size(), Renumber{now, kept.key.data()});
    pairs.sleep.change = true;
}

template<class Exec>
void list_moved_bodies(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const OutsideWrenches& outside)
{
    select(exec, "bodies of substeps", bodies.count,
           sleeping::IsMoved{bodies, pairs.view(), outside, pairs.sleep.shared()}, pairs.search.found, pairs.sort,
           pairs.sleep.moved);
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void       begin_sleep(const Exec&, Pairs<Exec>&, Bodies<Exec>&, const BodyRestRule&);                    \
    template SleepCount look_at_sleep(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&);                   \
    template SleepCount follow_beds(const Exec&, Pairs<Exec>&, const BodiesView&);                                     \
    template void       renew_watches(const Exec&, Pairs<Exec>&);                                                      \
    template void       fall_asleep(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&, BodyTotal*, double,  \
                                    const Vec3<double>&);                                                              \
    template void       wake_all(Pairs<Exec>&, Bodies<Exec>&);                                                         \
    template void       wake_bodies(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&, double);             \
    template void       settle_sleepers(const Exec&, Pairs<Exec>&, const BodiesView&);                                 \
    template void       hold_sleepers(const Exec&, Pairs<Exec>&, const BodiesView&);                                   \
    template void       resume_sleep(const Exec&, Pairs<Exec>&, const BodiesView&);                                    \
    template void renumber_sleeping_pairs(const Exec&, Pairs<Exec>&, const Array<Exec, std::int32_t>&, std::int64_t);  \
    template void list_moved_bodies(const Exec&, Pairs<Exec>&, const BodiesView&, const OutsideWrenches&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
