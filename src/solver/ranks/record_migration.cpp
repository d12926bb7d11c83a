#include "solver/ranks/record_migration.hpp"

#include <algorithm>
#include <map>

#include "backend/instantiate.hpp"
#include "decomp/messages.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"
#include "world/world.hpp"

namespace tread::solver
{
namespace
{

template<class Exec>
std::vector<world::ContactRecord> last_records(const dem::Pairs<Exec>& pairs)
{
    const std::vector<std::uint64_t>  keys    = pairs.last.key.to_host();
    const std::vector<dem::Patch>     patches = pairs.last.patch.to_host();
    const std::vector<dem::Rolling>   rolling = pairs.last.rolling.to_host();
    const std::vector<Vec3<double>>   places  = pairs.patches.last_place.to_host();
    std::vector<world::ContactRecord> records;
    records.reserve(keys.size());
    for (std::size_t p = 0; p < keys.size(); ++p)
    {
        records.push_back({keys[p], patches[p], rolling.empty() ? dem::no_rolling() : rolling[p],
                           places.empty() ? Vec3<double>::Zero() : places[p]});
    }
    return records;
}

template<class Exec>
void put_back(const std::vector<world::ContactRecord>& records, dem::Pairs<Exec>& pairs)
{
    std::vector<std::uint64_t> keys;
    std::vector<dem::Patch>    patches;
    std::vector<dem::Rolling>  rolling;
    for (const world::ContactRecord& record : records)
    {
        keys.push_back(record.key);
        patches.push_back(record.patch);
        rolling.push_back(record.rolling);
    }
    pairs.last.key.assign(keys);
    pairs.last.patch.assign(patches);
    if (pairs.resists_rolling) { pairs.last.rolling.assign(rolling); }
}

template<class Exec>
void put_places_back(const std::vector<world::ContactRecord>& records, dem::Pairs<Exec>& pairs)
{
    std::vector<Vec3<double>> places;
    places.reserve(records.size());
    for (const world::ContactRecord& record : records) { places.push_back(record.place); }
    pairs.patches.last_place.assign(places);
}

} // namespace

std::int64_t deciding_body(const std::vector<std::int32_t>& is_large, std::uint64_t key)
{
    const std::int64_t a = dem::first_of(key), b = dem::second_of(key);
    return b < static_cast<std::int64_t>(is_large.size()) ? dem::decider_of(is_large.data(), a, b) : a;
}

template<class Exec>
void migrate_records(const Communicator& communicator, dem::Pairs<Exec>& pairs,
                     const std::vector<std::int32_t>& is_large, const std::vector<BodyHolding>& decided)
{
    std::map<std::int64_t, std::size_t> moved; // destination rank by body
    for (const BodyHolding& body : decided)
    {
        if (body.owner != communicator.rank()) { moved[body.body] = static_cast<std::size_t>(body.owner); }
    }
    const bool have_places = communicator.maximum(pairs.patches.last_place.size() == 0 ? 0 : 1) > 0;

    std::vector<world::ContactRecord>              kept;
    std::vector<std::vector<world::ContactRecord>> leaving(static_cast<std::size_t>(communicator.size()));
    for (const world::ContactRecord& record : last_records(pairs))
    {
        const auto to = moved.find(deciding_body(is_large, record.key));
        (to == moved.end() ? kept : leaving[to->second]).push_back(record);
    }
    const auto by_key = [](const world::ContactRecord& a, const world::ContactRecord& b) { return a.key < b.key; };
    for (const auto& arriving : decomp::exchange_values(communicator, leaving))
    {
        const auto own = static_cast<std::ptrdiff_t>(kept.size());
        kept.insert(kept.end(), arriving.begin(), arriving.end());
        std::inplace_merge(kept.begin(), kept.begin() + own, kept.end(), by_key); // both parts are sorted
    }
    put_back(kept, pairs);
    if (have_places) { put_places_back(kept, pairs); }
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void migrate_records(const Communicator&, dem::Pairs<Exec>&, const std::vector<std::int32_t>&,            \
                                  const std::vector<BodyHolding>&)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
