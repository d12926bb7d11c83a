#include "solver/bodies/contact_records.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "decomp/messages.hpp"
#include "solver/ranks/over_ranks.hpp"
#include "solver/ranks/record_migration.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

/// Records of pairs as they are in memory, an array each.
struct RecordArrays
{
    std::vector<std::uint64_t> key;
    std::vector<dem::Patch>    patch;
    std::vector<dem::Rolling>  rolling;
    std::vector<Vec3<double>>  place;
};

template<class Exec>
RecordArrays listed_records(const dem::Pairs<Exec>& pairs)
{
    return {pairs.key.to_host(), pairs.patch.to_host(), pairs.rolling.to_host(), pairs.patches.place.to_host()};
}

/// Keeps the records of the pairs that this rank evaluates, by ascending key; all of them where the state is exact.
template<class Exec>
RecordArrays chosen_records(const BodyState<Exec>& state, const RecordArrays& all, const StateFile& file)
{
    std::vector<std::size_t> order;
    const auto               is_large = state.pairs.sizes.is_large.to_host();
    for (std::size_t p = 0; p < all.key.size(); ++p)
    {
        if (file.exact() || is_answered_here(state, is_large, all.key[p])) { order.push_back(p); }
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return all.key[a] < all.key[b]; });
    const auto chosen = [&](const auto& values)
    {
        std::decay_t<decltype(values)> some;
        for (const std::size_t p : order) { some.push_back(values[p]); }
        return some;
    };
    return {chosen(all.key), chosen(all.patch), chosen(all.rolling), chosen(all.place)};
}

/// Adds the contacts of sleepers, in the order of keys.
template<class Exec>
void add_sleeping_contacts(const BodyState<Exec>& state, std::vector<world::ContactRecord>& found)
{
    const dem::SleepingPairs<Exec>& pairs = state.pairs.sleep.pairs;
    if (pairs.key.size() == 0) { return; }
    const RecordArrays kept{pairs.key.to_host(), pairs.patch.to_host(), pairs.rolling.to_host(), pairs.place.to_host()};
    for (std::size_t p = 0; p < kept.key.size(); ++p)
    {
        if (!(kept.patch[p].stiffness > 0)) { continue; }
        found.push_back({dem::whole_pair(state.numbers().key_in_scene(kept.key[p])), kept.patch[p],
                         kept.rolling.empty() ? dem::no_rolling() : kept.rolling[p], kept.place[p]});
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
}

} // namespace

template<class Exec>
bool is_answered_here(const BodyState<Exec>& state, const std::vector<std::int32_t>& is_large, std::uint64_t key)
{
    return !state.ranks || state.owns(deciding_body(is_large, key));
}

KeyBound accepted_keys(const world::World& world)
{
    const auto        bodies = static_cast<std::int64_t>(world.bodies.size());
    const auto        sides  = bodies + static_cast<std::int64_t>(world.planes.size());
    const std::string pair   = fmt::format("the key of two of {} bodies and walls, the first a body", sides);
    const auto        is_key = [=](std::uint64_t key)
    {
        const std::int64_t a = dem::first_of(key), b = dem::second_of(key);
        return a < bodies && a < b && b < sides;
    };
    return accept::each(pair, is_key);
}

template<class Exec>
void restore_contacts(BodyState<Exec>& state)
{
    const std::vector<world::ContactRecord>& contacts = state.world.contacts;
    if (contacts.empty()) { return; }
    RecordArrays records;
    records.key.reserve(contacts.size());
    records.patch.reserve(contacts.size());
    records.rolling.reserve(contacts.size());
    records.place.reserve(contacts.size());
    bool       several  = false;
    const auto is_large = state.pairs.sizes.is_large.to_host();
    for (const world::ContactRecord& contact : contacts)
    {
        const auto key = state.numbers().find_key(contact.key);
        if (!key || !is_answered_here(state, is_large, *key)) { continue; }
        const bool again = !records.key.empty() && dem::same_pair(records.key.back(), *key);
        several          = several || again;
        records.key.push_back(again ? records.key.back() + 1 : *key);
        records.place.push_back(contact.place);
        records.patch.push_back(contact.patch);
        records.rolling.push_back(contact.rolling);
    }
    dem::Pairs<Exec>& pairs = state.pairs;
    pairs.key.assign(records.key);
    pairs.patch.assign(records.patch);
    if (pairs.resists_rolling) { pairs.rolling.assign(records.rolling); }
    if (several) { pairs.patches.place.assign(records.place); }
}

template<class Exec>
std::vector<world::ContactRecord> live_contacts(const BodyState<Exec>& state)
{
    const RecordArrays                listed = listed_records(state.pairs);
    std::vector<world::ContactRecord> found;
    for (std::size_t p = 0; p < listed.key.size(); ++p)
    {
        if (!(listed.patch[p].stiffness > 0)) { continue; }
        found.push_back({dem::whole_pair(state.numbers().key_in_scene(listed.key[p])), listed.patch[p],
                         state.pairs.resists_rolling ? listed.rolling[p] : dem::no_rolling(),
                         listed.place.empty() ? Vec3<double>::Zero() : listed.place[p]});
    }
    add_sleeping_contacts(state, found);
    if (!state.ranks) { return found; }
    std::vector<world::ContactRecord> all;
    for (const auto& records : decomp::gather_values(*state.communicator(), found))
    {
        all.insert(all.end(), records.begin(), records.end());
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    return all;
}

template<class Exec>
void take_keys_here(const BodyState<Exec>& state, std::vector<std::uint64_t>& keys, const StateFile& file,
                    const char* name)
{
    check_on_ranks(state.communicator(),
                   [&]
                   {
                       for (std::size_t p = 0; p < keys.size(); ++p)
                       {
                           const auto key = state.numbers().find_key(keys[p]);
                           if (!key)
                           {
                               file.refuse(name, {static_cast<std::int64_t>(p), "another pair",
                                                  "a pair of bodies that the rank has rows for"});
                           }
                           keys[p] = *key;
                       }
                   });
}

template<class Exec>
void transfer_contacts(BodyState<Exec>& state, StateFile& file)
{
    dem::Pairs<Exec>& pairs       = state.pairs;
    RecordArrays      records     = listed_records(pairs);
    bool              with_places = file.communicator().maximum(records.place.empty() ? 0 : 1) > 0;
    records.rolling.resize(records.key.size(), dem::no_rolling());
    records.place.resize(records.key.size(), Vec3<double>::Zero());
    file.numbers("pairs/several", with_places);
    for (std::uint64_t& key : records.key) { key = state.numbers().key_in_scene(key); }
    const auto keys = accepted_keys(state.world);
    if (file.exact()) { file.own_or_all("pairs/key", records.key, accept::all(keys, accept::ascending())); }
    else { file.own_or_all("pairs/key", records.key, keys); }
    const auto of_each_pair = accept::all(accept::rows(records.key.size()), accept::finite());
    file.own_or_all("pairs/patch", records.patch, of_each_pair);
    file.own_or_all("pairs/rolling", records.rolling, of_each_pair);
    file.own_or_all("pairs/place", records.place, of_each_pair);
    if (!file.loads()) { return; }

    take_keys_here(state, records.key, file, "pairs/key");
    const RecordArrays chosen = chosen_records(state, records, file);
    pairs.key.assign(chosen.key);
    pairs.patch.assign(chosen.patch);
    if (pairs.resists_rolling) { pairs.rolling.assign(chosen.rolling); }
    pairs.patches.place.resize(0);
    if (with_places) { pairs.patches.place.assign(chosen.place); }
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template bool is_answered_here(const BodyState<Exec>&, const std::vector<std::int32_t>&, std::uint64_t);           \
    template void take_keys_here(const BodyState<Exec>&, std::vector<std::uint64_t>&, const StateFile&, const char*);  \
    template void restore_contacts(BodyState<Exec>&);                                                                  \
    template std::vector<world::ContactRecord> live_contacts(const BodyState<Exec>&);                                  \
    template void                              transfer_contacts(BodyState<Exec>&, StateFile&)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
