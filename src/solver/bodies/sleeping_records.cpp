#include "solver/bodies/sleeping_records.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "backend/instantiate.hpp"
#include "solver/bodies/contact_records.hpp"
#include "solver/ranks/sleeping_pair_migration.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

template<class Exec>
void transfer_records(const BodyState<Exec>& state, StateFile& file, SleepingRecords& records)
{
    std::vector<std::uint64_t> keys;
    for (const SleepingRecord& one : records) { keys.push_back(state.numbers().key_in_scene(one.record.key)); }
    const auto are_keys = accept::all(accepted_keys(state.world), accept::distinct());
    if (file.exact()) { file.own_or_all("rock_sleep/key", keys, accept::all(are_keys, accept::ascending())); }
    else { file.own_or_all("rock_sleep/key", keys, are_keys); }
    records.resize(keys.size(), {{0, dem::no_patch(), dem::no_rolling(), Vec3<double>::Zero()}, {}});
    const auto transfer = [&](const char* name, auto value_of)
    {
        std::vector<std::decay_t<decltype(value_of(records[0]))>> values;
        for (SleepingRecord& one : records) { values.push_back(value_of(one)); }
        file.own_or_all(name, values, accept::all(accept::rows(keys.size()), accept::finite()));
        for (std::size_t p = 0; p < values.size(); ++p) { value_of(records[p]) = values[p]; }
    };
    transfer("rock_sleep/patch", [](SleepingRecord& one) -> dem::Patch& { return one.record.patch; });
    transfer("rock_sleep/place", [](SleepingRecord& one) -> Vec3<double>& { return one.record.place; });
    if (state.pairs.resists_rolling)
    {
        transfer("rock_sleep/rolling", [](SleepingRecord& one) -> dem::Rolling& { return one.record.rolling; });
    }
    transfer("rock_sleep/contact", [](SleepingRecord& one) -> dem::HeldContact& { return one.contact; });
    if (!file.loads()) { return; }
    take_keys_here(state, keys, file, "rock_sleep/key");
    for (std::size_t p = 0; p < keys.size(); ++p) { records[p].record.key = keys[p]; }
}

/// Adds the records that this rank evaluates to those of the previous list.
template<class Exec>
void wake_records(BodyState<Exec>& state, const SleepingRecords& records)
{
    dem::Pairs<Exec>&          pairs    = state.pairs;
    const auto                 is_large = pairs.sizes.is_large.to_host();
    std::vector<std::uint64_t> keys     = pairs.key.to_host();
    std::vector<dem::Patch>    patches  = pairs.patch.to_host();
    std::vector<dem::Rolling>  rolling  = pairs.rolling.to_host();
    std::vector<Vec3<double>>  places   = pairs.patches.place.to_host();
    rolling.resize(keys.size(), dem::no_rolling());
    places.resize(keys.size(), Vec3<double>::Zero());
    for (const SleepingRecord& one : records)
    {
        if (!is_answered_here(state, is_large, one.record.key)) { continue; }
        keys.push_back(one.record.key);
        patches.push_back(one.record.patch);
        rolling.push_back(one.record.rolling);
        places.push_back(one.record.place);
    }
    std::vector<std::size_t> order(keys.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
    const auto sorted = [&](const auto& values)
    {
        std::decay_t<decltype(values)> some;
        for (const std::size_t p : order) { some.push_back(values[p]); }
        return some;
    };
    pairs.key.assign(sorted(keys));
    pairs.patch.assign(sorted(patches));
    if (pairs.resists_rolling) { pairs.rolling.assign(sorted(rolling)); }
    if (pairs.patches.wanted) { pairs.patches.place.assign(sorted(places)); }
}

} // namespace

template<class Exec>
void transfer_sleeping_pairs(BodyState<Exec>& state, StateFile& file)
{
    SleepingRecords records = read_sleeping_pairs(state.pairs.sleep.pairs);
    transfer_records(state, file, records);
    if (!file.loads()) { return; }
    if (file.exact()) { write_sleeping_pairs(state.pairs, std::move(records)); }
    else { wake_records(state, records); }
}

#define TREAD_INSTANTIATE(Exec) template void transfer_sleeping_pairs(BodyState<Exec>&, StateFile&)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
