#include <algorithm>
#include <map>

#include "decomp/letters.hpp"
#include "kernels/dem/pairs_kern.hpp"
#include "solver/body_ranks.hpp"

// What contacts remember goes with the body that decides who answers them.
namespace tread::solver
{
namespace
{

template<class Exec>
std::vector<ContactRecord> last_records(const dem::Pairs<Exec>& pairs)
{
    const std::vector<std::uint64_t> keys    = pairs.last_key.to_host();
    const std::vector<dem::Patch>    patches = pairs.last_patch.to_host();
    const std::vector<dem::Rolling>  rolling = pairs.last_rolling.to_host();
    const std::vector<Vec3<double>>  places  = pairs.patches.last_place.to_host();
    std::vector<ContactRecord>       records;
    records.reserve(keys.size());
    for (std::size_t p = 0; p < keys.size(); ++p)
    {
        records.push_back({keys[p], patches[p], rolling.empty() ? dem::no_rolling() : rolling[p],
                           places.empty() ? Vec3<double>::Zero() : places[p]});
    }
    return records;
}

template<class Exec>
void put_back(const std::vector<ContactRecord>& records, bool with_places, dem::Pairs<Exec>& pairs)
{
    std::vector<std::uint64_t> keys;
    std::vector<dem::Patch>    patches;
    std::vector<dem::Rolling>  rolling;
    std::vector<Vec3<double>>  places;
    for (const ContactRecord& record : records)
    {
        keys.push_back(record.key);
        patches.push_back(record.patch);
        rolling.push_back(record.rolling);
        places.push_back(record.place);
    }
    pairs.last_key.assign(keys);
    pairs.last_patch.assign(patches);
    if (pairs.resists_rolling) { pairs.last_rolling.assign(rolling); }
    if (with_places) { pairs.patches.last_place.assign(places); }
}

} // namespace

template<class Exec>
void BodyRanks<Exec>::hand_over_records(dem::Pairs<Exec>& pairs, const std::vector<Holding>& decided)
{
    std::map<std::int64_t, std::size_t> moved; // to which rank
    for (const Holding& body : decided)
    {
        if (body.owner != communicator_.rank()) { moved[body.body] = static_cast<std::size_t>(body.owner); }
    }
    if (all(moved.empty())) { return; }
    const bool with_places = !all(pairs.patches.last_place.size() == 0);

    const std::vector<std::int32_t>         is_large = pairs.is_large.to_host();
    std::vector<ContactRecord>              kept;
    std::vector<std::vector<ContactRecord>> leaving(rank_count());
    for (const ContactRecord& record : last_records(pairs))
    {
        const auto to = moved.find(decider(is_large, record.key));
        (to == moved.end() ? kept : leaving[to->second]).push_back(record);
    }
    for (const auto& arriving : decomp::exchange_values(communicator_, leaving))
    {
        kept.insert(kept.end(), arriving.begin(), arriving.end());
    }
    std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    put_back(kept, with_places, pairs);
}

template void BodyRanks<Cpu>::hand_over_records(dem::Pairs<Cpu>&, const std::vector<Holding>&);
#ifdef TREAD_WITH_CUDA
template void BodyRanks<Gpu>::hand_over_records(dem::Pairs<Gpu>&, const std::vector<Holding>&);
#endif

} // namespace tread::solver
