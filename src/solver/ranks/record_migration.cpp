#include "solver/ranks/record_migration.hpp"

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

} // namespace

std::map<std::int64_t, std::size_t> destinations(const BodyHoldings& decided, const BodyNumbers& numbers,
                                                 std::int32_t here)
{
    std::map<std::int64_t, std::size_t> moved;
    for (const BodyHolding& body : decided)
    {
        if (body.owner != here) { moved[numbers.find_row(body.body).value()] = static_cast<std::size_t>(body.owner); }
    }
    return moved;
}

std::int64_t deciding_body(const std::vector<std::int32_t>& is_large, std::uint64_t key)
{
    const std::int64_t a = dem::first_of(key), b = dem::second_of(key);
    return b < static_cast<std::int64_t>(is_large.size()) ? dem::decider_of(is_large.data(), a, b) : a;
}

template<class Exec>
RecordMigration<Exec>::RecordMigration(const Exec& exec)
    : exec_(exec)
    , body_(exec, "leaving bodies")
    , marks_(exec, "marks of leaving bodies")
{
}

template<class Exec>
void RecordMigration<Exec>::take(const Communicator& communicator, dem::Pairs<Exec>& pairs, const BodyNumbers& numbers,
                                 const BodyHoldings& decided)
{
    leaving_.assign(static_cast<std::size_t>(communicator.size()), {});
    const auto moved = destinations(decided, numbers, communicator.rank());
    if (moved.empty()) { return; }
    std::vector<std::int32_t> rows;
    rows.reserve(moved.size());
    for (const auto& [row, rank] : moved) { rows.push_back(static_cast<std::int32_t>(row)); }
    body_.assign(rows);
    marks_.resize(static_cast<std::int64_t>(numbers.rows()));
    contact::forget_places(exec_, marks_);
    contact::write_places(exec_, body_, marks_);
    const std::vector<std::int32_t> is_large = pairs.sizes.is_large.to_host();
    for (world::ContactRecord record : on_host(dem::take_records(exec_, pairs, marks_)))
    {
        Records& to = leaving_[moved.at(deciding_body(is_large, record.key))];
        record.key  = numbers.key_in_scene(record.key);
        to.push_back(record);
    }
}

template<class Exec>
void RecordMigration<Exec>::send(const Communicator& communicator, dem::Pairs<Exec>& pairs, const BodyNumbers& numbers)
{
    const bool has_places = communicator.maximum(pairs.patches.last_place.size() == 0 ? 0 : 1) > 0;
    Records    all;
    for (const Records& arriving : decomp::exchange_values(communicator, leaving_))
    {
        for (world::ContactRecord record : arriving)
        {
            const auto key = numbers.find_key(record.key);
            if (!key) { continue; } // the other body is out of reach
            record.key = *key;
            all.push_back(record);
        }
    }
    leaving_.clear();
    dem::RecordRows<Exec> rows = rows_of(exec_, all);
    if (!pairs.resists_rolling) { rows.rolling.resize(0); }
    if (!has_places) { rows.place.resize(0); }
    dem::add_records(exec_, pairs, rows);
}

#define TREAD_INSTANTIATE(Exec) template class RecordMigration<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
