#pragma once

#include "kernels/dem/pairs/pairs_impl.hpp"
#include "kernels/dem/pairs/select.hpp"

// Pairs of sleepers, kept apart from the list of the substeps; a part of sleep_impl.hpp.
namespace tread::dem::sleeping
{

/// Whether a listed pair is one of two sleepers, or of one and a wall.
TREAD_HD bool is_pair_of_sleepers(const BodiesView& bodies, std::uint64_t key)
{
    const std::int64_t b = second_of(key);
    return bodies.is_asleep(first_of(key)) && (b >= bodies.count || bodies.is_asleep(b));
}

struct FallsAsleep
{
    BodiesView bodies;
    PairsView  pairs;

    TREAD_HD bool operator()(std::int64_t p) const { return is_pair_of_sleepers(bodies, pairs.key[p]); }
};

struct StaysAsleep
{
    BodiesView        bodies;
    SleepingPairsView pairs;

    TREAD_HD bool operator()(std::int64_t p) const { return is_pair_of_sleepers(bodies, pairs.key[p]); }
};

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

} // namespace tread::dem::sleeping
