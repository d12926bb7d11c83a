#include "solver/ranks/sleeping_pair_migration.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "backend/instantiate.hpp"
#include "decomp/messages.hpp"
#include "solver/ranks/record_migration.hpp"

namespace tread::solver
{

template<class Exec>
SleepingRecords read_sleeping_pairs(const dem::SleepingPairs<Exec>& pairs)
{
    const auto      keys     = pairs.key.to_host();
    const auto      patches  = pairs.patch.to_host();
    const auto      rolling  = pairs.rolling.to_host();
    const auto      places   = pairs.place.to_host();
    const auto      contacts = pairs.contact.to_host();
    SleepingRecords records;
    records.reserve(keys.size());
    for (std::size_t p = 0; p < keys.size(); ++p)
    {
        const dem::Rolling moment = rolling.empty() ? dem::no_rolling() : rolling[p];
        records.push_back({{keys[p], patches[p], moment, places[p]}, contacts[p]});
    }
    return records;
}

template<class Exec>
void write_sleeping_pairs(dem::Pairs<Exec>& pairs, SleepingRecords records)
{
    const auto by_key = [](const SleepingRecord& a, const SleepingRecord& b) { return a.record.key < b.record.key; };
    std::sort(records.begin(), records.end(), by_key);
    const auto values = [&](auto member)
    {
        std::vector<std::decay_t<decltype(records[0].record.*member)>> found;
        found.reserve(records.size());
        for (const SleepingRecord& one : records) { found.push_back(one.record.*member); }
        return found;
    };
    std::vector<dem::HeldContact> contacts;
    contacts.reserve(records.size());
    for (const SleepingRecord& one : records) { contacts.push_back(one.contact); }
    dem::SleepingPairs<Exec>& kept = pairs.sleep.pairs;
    kept.key.assign(values(&world::ContactRecord::key));
    kept.patch.assign(values(&world::ContactRecord::patch));
    kept.place.assign(values(&world::ContactRecord::place));
    if (pairs.resists_rolling) { kept.rolling.assign(values(&world::ContactRecord::rolling)); }
    kept.contact.assign(contacts);
    pairs.sleep.change = true;
}

template<class Exec>
void SleepingPairMigration<Exec>::take(const Communicator& communicator, dem::Pairs<Exec>& pairs,
                                       const BodyNumbers& numbers, const BodyHoldings& decided)
{
    leaving_.assign(static_cast<std::size_t>(communicator.size()), {});
    const auto moved = destinations(decided, numbers, communicator.rank());
    if (moved.empty() || pairs.sleep.pairs.key.size() == 0) { return; }
    const std::vector<std::int32_t> is_large = pairs.sizes.is_large.to_host();
    SleepingRecords                 stay;
    bool                            any = false;
    for (SleepingRecord& one : read_sleeping_pairs(pairs.sleep.pairs))
    {
        const auto to = moved.find(deciding_body(is_large, one.record.key));
        if (to == moved.end())
        {
            stay.push_back(one);
            continue;
        }
        one.record.key = numbers.key_in_scene(one.record.key);
        leaving_[to->second].push_back(one);
        any = true;
    }
    if (any) { write_sleeping_pairs(pairs, std::move(stay)); }
}

template<class Exec>
void SleepingPairMigration<Exec>::send(const Communicator& communicator, dem::Pairs<Exec>& pairs,
                                       const BodyNumbers& numbers)
{
    SleepingRecords all;
    for (const SleepingRecords& arriving : decomp::exchange_values(communicator, leaving_))
    {
        for (SleepingRecord one : arriving)
        {
            const auto key = numbers.find_key(one.record.key);
            if (!key) { continue; } // the other body is out of reach
            one.record.key = *key;
            all.push_back(one);
        }
    }
    leaving_.clear();
    if (all.empty()) { return; }
    const SleepingRecords kept = read_sleeping_pairs(pairs.sleep.pairs);
    all.insert(all.end(), kept.begin(), kept.end());
    write_sleeping_pairs(pairs, std::move(all));
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template SleepingRecords read_sleeping_pairs(const dem::SleepingPairs<Exec>&);                                     \
    template void            write_sleeping_pairs(dem::Pairs<Exec>&, SleepingRecords);                                 \
    template class SleepingPairMigration<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
