#include <algorithm>

#include "backend/instantiate.hpp"
#include "decomp/messages.hpp"
#include "solver/dem_solver.hpp"

// Extracts contact records from a run, and restores them in another.
namespace tread::solver
{

/// Stores the world's contacts as the search's previous list: pairs found again keep their records.
template<class Exec>
void DemSolver<Exec>::restore_contacts()
{
    if (world_.contacts.empty()) { return; }
    std::vector<std::uint64_t> keys;
    std::vector<dem::Patch>    patches;
    std::vector<dem::Rolling>  rolling;
    std::vector<Vec3<double>>  places;
    rolling.reserve(world_.contacts.size());
    places.reserve(world_.contacts.size());
    keys.reserve(world_.contacts.size());
    patches.reserve(world_.contacts.size());
    bool       several  = false;
    const auto is_large = pairs_.is_large.to_host();
    for (const world::ContactRecord& contact : world_.contacts)
    {
        if (ranks_ && !ranks_->owns(ranks_->decider(is_large, contact.key))) { continue; }
        const bool again = !keys.empty() && dem::same_pair(keys.back(), contact.key);
        several          = several || again;
        keys.push_back(again ? keys.back() + 1 : contact.key);
        places.push_back(contact.place);
        patches.push_back(contact.patch);
        rolling.push_back(contact.rolling);
    }
    pairs_.key.assign(keys);
    pairs_.patch.assign(patches);
    if (pairs_.resists_rolling) { pairs_.rolling.assign(rolling); }
    if (several) { pairs_.patches.place.assign(places); }
}

template<class Exec>
std::vector<world::ContactRecord> DemSolver<Exec>::contacts() const
{
    const std::vector<std::uint64_t>  keys    = pairs_.key.to_host();
    const std::vector<dem::Patch>     patches = pairs_.patch.to_host();
    const std::vector<dem::Rolling>   rolling = pairs_.rolling.to_host();
    const std::vector<Vec3<double>>   places  = pairs_.patches.place.to_host();
    std::vector<world::ContactRecord> found;
    for (std::size_t p = 0; p < keys.size(); ++p)
    {
        if (!(patches[p].stiffness > 0)) { continue; }
        found.push_back({dem::whole_pair(keys[p]), patches[p], pairs_.resists_rolling ? rolling[p] : dem::no_rolling(),
                         places.empty() ? Vec3<double>::Zero() : places[p]});
    }
    if (!ranks_) { return found; }
    std::vector<world::ContactRecord> all;
    for (const auto& records : decomp::gather_values(ranks_->communicator(), found))
    {
        all.insert(all.end(), records.begin(), records.end());
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    return all;
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void                              DemSolver<Exec>::restore_contacts();                                    \
    template std::vector<world::ContactRecord> DemSolver<Exec>::contacts() const
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
