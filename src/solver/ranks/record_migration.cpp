#include "solver/ranks/record_migration.hpp"

#include <map>

#include "backend/instantiate.hpp"
#include "decomp/messages.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"
#include "world/world.hpp"

namespace tread::solver
{
namespace
{

using Records = std::vector<world::ContactRecord>;

template<class Exec>
Records on_host(const dem::RecordRows<Exec>& rows)
{
    const std::vector<std::uint64_t> keys    = rows.key.to_host();
    const std::vector<dem::Patch>    patches = rows.patch.to_host();
    const std::vector<dem::Rolling>  rolling = rows.rolling.to_host();
    const std::vector<Vec3<double>>  places  = rows.place.to_host();
    Records                          records;
    for (std::size_t p = 0; p < keys.size(); ++p)
    {
        records.push_back({keys[p], patches[p], rolling.empty() ? dem::no_rolling() : rolling[p],
                           places.empty() ? Vec3<double>::Zero() : places[p]});
    }
    return records;
}

/// Rows of records, with all arrays.
template<class Exec>
dem::RecordRows<Exec> rows_of(const Exec& exec, const Records& records)
{
    const auto values = [&](auto member)
    {
        std::vector<std::decay_t<decltype(records[0].*member)>> found;
        for (const world::ContactRecord& record : records) { found.push_back(record.*member); }
        return found;
    };
    dem::RecordRows<Exec> rows(exec);
    rows.key.assign(values(&world::ContactRecord::key));
    rows.patch.assign(values(&world::ContactRecord::patch));
    rows.rolling.assign(values(&world::ContactRecord::rolling));
    rows.place.assign(values(&world::ContactRecord::place));
    return rows;
}

/// Destination rank of every body that leaves.
std::map<std::int64_t, std::size_t> destinations(const BodyHoldings& decided, std::int32_t here)
{
    std::map<std::int64_t, std::size_t> moved;
    for (const BodyHolding& body : decided)
    {
        if (body.owner != here) { moved[body.body] = static_cast<std::size_t>(body.owner); }
    }
    return moved;
}

} // namespace

std::int64_t deciding_body(const std::vector<std::int32_t>& is_large, std::uint64_t key)
{
    const std::int64_t a = dem::first_of(key), b = dem::second_of(key);
    return b < static_cast<std::int64_t>(is_large.size()) ? dem::decider_of(is_large.data(), a, b) : a;
}

template<class Exec>
RecordMigration<Exec>::RecordMigration(const Exec& exec, std::size_t bodies)
    : exec_(exec)
    , body_(exec, "leaving bodies")
    , leaving_(exec, "marks of leaving bodies")
{
    leaving_.assign(std::vector<std::int32_t>(bodies, -1));
}

template<class Exec>
void RecordMigration<Exec>::run(const Communicator& communicator, dem::Pairs<Exec>& pairs,
                                const std::vector<std::int32_t>& is_large, const BodyHoldings& decided)
{
    const auto moved      = destinations(decided, communicator.rank());
    const bool has_places = communicator.maximum(pairs.patches.last_place.size() == 0 ? 0 : 1) > 0;

    std::vector<Records> leaving(static_cast<std::size_t>(communicator.size()));
    for (const world::ContactRecord& record : take(pairs, moved))
    {
        leaving[moved.at(deciding_body(is_large, record.key))].push_back(record);
    }
    Records all;
    for (const Records& arriving : decomp::exchange_values(communicator, leaving))
    {
        all.insert(all.end(), arriving.begin(), arriving.end());
    }
    dem::RecordRows<Exec> rows = rows_of(exec_, all);
    if (!pairs.resists_rolling) { rows.rolling.resize(0); }
    if (!has_places) { rows.place.resize(0); }
    dem::add_records(exec_, pairs, rows);
}

template<class Exec>
std::vector<world::ContactRecord> RecordMigration<Exec>::take(dem::Pairs<Exec>&                          pairs,
                                                              const std::map<std::int64_t, std::size_t>& moved)
{
    if (moved.empty()) { return {}; }
    std::vector<std::int32_t> bodies;
    bodies.reserve(moved.size());
    for (const auto& [body, rank] : moved) { bodies.push_back(static_cast<std::int32_t>(body)); }
    body_.assign(bodies);
    contact::write_places(exec_, body_, leaving_);
    Records records = on_host(dem::take_records(exec_, pairs, leaving_));
    contact::erase_places(exec_, body_, leaving_);
    return records;
}

#define TREAD_INSTANTIATE(Exec) template class RecordMigration<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
