#pragma once

#include "backend/instantiate.hpp"
#include "kernels/dem/contact/body_contact.hpp"
#include "kernels/dem/pairs/pairs_impl.hpp"
#include "kernels/dem/pairs/records_kern.hpp"
#include "kernels/dem/pairs/select.hpp"
#include "kernels/dem/sleep/sleep_kern.hpp"

// Steps of sleep.hpp, for both backends; sleep.cpp and sleep.cu provide for_each.
namespace tread::dem::sleeping
{

/// Numbers that a row of the new pairs of sleepers comes from: i = row i of them now, ~p = pair p of the list.
struct WriteOrigins
{
    std::int64_t         count; ///< rows now
    const std::uint64_t* key;
    const std::uint64_t* listed_key;
    const std::int32_t*  chosen; ///< pairs of the list that become rows
    std::uint64_t*       new_key;
    std::int32_t*        origin;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int32_t p = i < count ? 0 : chosen[i - count];
        new_key[i]           = i < count ? key[i] : listed_key[p];
        origin[i]            = i < count ? static_cast<std::int32_t>(i) : ~p;
    }
};

struct TakeRows
{
    SleepingPairsView   from;
    PairsView           listed;
    const Vec3<double>* listed_place; ///< null if no listed pair has several patches
    const std::int32_t* origin;
    std::uint64_t*      key;
    Patch*              patch;
    Rolling*            rolling; ///< null without rolling friction
    Vec3<double>*       place;
    HeldContact*        contact;

    TREAD_HD void operator()(std::int64_t i) const
    {
        if (origin[i] >= 0) { keep(i, origin[i]); }
        else { take(i, ~origin[i]); }
    }

private:
    TREAD_HD void keep(std::int64_t i, std::int64_t p) const
    {
        key[i]     = from.key[p];
        patch[i]   = from.patch[p];
        place[i]   = from.place[p];
        contact[i] = from.contact[p];
        if (rolling != nullptr) { rolling[i] = from.rolling[p]; }
    }

    TREAD_HD void take(std::int64_t i, std::int64_t p) const
    {
        const AnswersView& answers = listed.answers;
        key[i]                     = listed.key[p];
        patch[i]                   = listed.patch[p];
        place[i]                   = listed_place != nullptr ? listed_place[p] : Vec3<double>(Vec3<double>::Zero());
        contact[i]                 = {answers.force[p], answers.torque[p], answers.second_torque[answers.place[p]],
                                      answers.stiffness[p], answers.energy[p]};
        if (rolling != nullptr) { rolling[i] = listed.rolling[p]; }
    }
};

/// Replaces the pairs of sleepers by rows of these origins, ascending by key.
template<class Exec>
void take_rows(const Exec& exec, Pairs<Exec>& pairs, const Array<Exec, std::int32_t>& origin)
{
    SleepingPairs<Exec>& now = pairs.sleep.pairs;
    SleepingPairs<Exec>  next(exec);
    const std::int64_t   count = origin.size();
    next.key.resize(count);
    next.patch.resize(count);
    next.place.resize(count);
    next.contact.resize(count);
    if (pairs.resists_rolling) { next.rolling.resize(count); }
    for_each(exec, "take sleeping pairs", count,
             TakeRows{now.view(), pairs.view(), pairs.patches.place.size() > 0 ? pairs.patches.place.data() : nullptr,
                      origin.data(), next.key.data(), next.patch.data(),
                      pairs.resists_rolling ? next.rolling.data() : nullptr, next.place.data(), next.contact.data()});
    now.key.swap(next.key);
    now.patch.swap(next.patch);
    now.rolling.swap(next.rolling);
    now.place.swap(next.place);
    now.contact.swap(next.contact);
}

/// Adds the listed pairs of two sleepers to those that are kept.
template<class Exec>
void keep_contacts(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    SleepingPairs<Exec>&       kept = pairs.sleep.pairs;
    Array<Exec, std::int32_t>  chosen(exec, "pairs that fall asleep"), origin(exec, "origins of sleeping pairs");
    Array<Exec, std::uint64_t> key(exec, "keys of sleeping pairs");
    select(exec, "pairs that fall asleep", pairs.key.size(), FallsAsleep{bodies, pairs.view()}, pairs.search.found,
           pairs.sort, chosen);
    if (chosen.size() == 0) { return; }
    const std::int64_t count = kept.key.size() + chosen.size();
    key.resize(count);
    origin.resize(count);
    for_each(
        exec, "sleeping pair origins", count,
        WriteOrigins{kept.key.size(), kept.key.data(), pairs.key.data(), chosen.data(), key.data(), origin.data()});
    sort_by_key(exec, key, origin, pairs.sort, 32 + bits_below(bodies.count));
    take_rows(exec, pairs, origin);
}

/// Drops the pairs of bodies that woke.
template<class Exec>
void drop_contacts(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    SleepingPairs<Exec>& kept = pairs.sleep.pairs;
    if (kept.key.size() == 0) { return; }
    Array<Exec, std::int32_t> origin(exec, "origins of sleeping pairs");
    select(exec, "pairs that stay asleep", kept.key.size(), StaysAsleep{bodies, kept.view()}, pairs.search.found,
           pairs.sort, origin);
    if (origin.size() < kept.key.size()) { take_rows(exec, pairs, origin); }
}

struct OrderRow
{
    const std::uint64_t* key;
    std::uint64_t*       second_key;
    std::int32_t*        by_second;

    TREAD_HD void operator()(std::int64_t p) const
    {
        second_key[p] = static_cast<std::uint64_t>(second_of(key[p]));
        by_second[p]  = static_cast<std::int32_t>(p);
    }
};

/// Writes the runs of each body.
template<class Exec>
void order_contacts(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    SleepingPairs<Exec>&       kept  = pairs.sleep.pairs;
    const std::int64_t         count = kept.key.size();
    Array<Exec, std::uint64_t> second_key(exec, "second bodies of sleeping pairs", count);
    kept.by_second.resize(count);
    for_each(exec, "order sleeping pairs", count, OrderRow{kept.key.data(), second_key.data(), kept.by_second.data()});
    sort_by_key(exec, second_key, kept.by_second, pairs.sort, bits_below(most_bodies));
    kept.first.resize(bodies.count + 1);
    kept.second.resize(bodies.count + 1);
    for_each(exec, "sleeping pairs of bodies", bodies.count + 1,
             pair_steps::WriteRuns{count, kept.key.data(), second_key.data(), kept.first.data(), kept.second.data()});
}

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
    for_each(exec, "mark sleepers near", bodies.count * PairSearch::parts,
             MarkNear{pair_steps::make_search(pairs, bodies, law, cell_size), sleep.moves.data(), sleep.mark.data()});
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
