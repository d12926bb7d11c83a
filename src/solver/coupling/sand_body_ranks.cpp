#include <algorithm>
#include <utility>

#include "backend/instantiate.hpp"
#include "decomp/messages.hpp"
#include "solver/coupling/sand_body_coupling.hpp"

// Sends contacts of sand and bodies to the ranks that their points have gone to.
namespace tread::solver
{
namespace
{

using PointIds = std::vector<std::uint32_t>;

/// A row of contact::SleepingContacts.
struct SleepingRow
{
    std::uint64_t       key;
    contact::Tangential tangential;
    contact::HeldSand   response;
    std::int32_t        material;
};
using SleepingRows = std::vector<SleepingRow>;

template<class Exec>
SleepingRows read_rows(const contact::SleepingContacts<Exec>& sleeping)
{
    const auto   key        = sleeping.key.to_host();
    const auto   tangential = sleeping.tangential.to_host();
    const auto   response   = sleeping.response.to_host();
    const auto   material   = sleeping.material.to_host();
    SleepingRows rows;
    rows.reserve(key.size());
    for (std::size_t i = 0; i < key.size(); ++i) { rows.push_back({key[i], tangential[i], response[i], material[i]}); }
    return rows;
}

/// Replaces all rows, given in any order.
template<class Exec>
void write_rows(contact::SleepingContacts<Exec>& sleeping, SleepingRows rows)
{
    std::sort(rows.begin(), rows.end(), [](const SleepingRow& a, const SleepingRow& b) { return a.key < b.key; });
    const auto values = [&](auto member)
    {
        std::vector<std::decay_t<decltype(rows[0].*member)>> found;
        found.reserve(rows.size());
        for (const SleepingRow& row : rows) { found.push_back(row.*member); }
        return found;
    };
    sleeping.key.assign(values(&SleepingRow::key));
    sleeping.tangential.assign(values(&SleepingRow::tangential));
    sleeping.response.assign(values(&SleepingRow::response));
    sleeping.material.assign(values(&SleepingRow::material));
}

/// Rank that a point has gone to; the number of ranks if it stays. `ids`: by rank, ascending.
std::size_t destination(const std::vector<PointIds>& ids, std::uint32_t point)
{
    const auto has = [&](const PointIds& of_rank) { return std::binary_search(of_rank.begin(), of_rank.end(), point); };
    return static_cast<std::size_t>(std::find_if(ids.begin(), ids.end(), has) - ids.begin());
}

} // namespace

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::send_records_after(const std::vector<std::vector<std::uint32_t>>& migrated_out)
{
    contact::keep_history(exec_, contact_);
    contact_.tangential.resize(0); // the records are in the table until the next search
    std::vector<std::vector<contact::HistoryRecord>> leaving;
    leaving.reserve(migrated_out.size());
    for (const auto& ids : migrated_out) { leaving.push_back(contact::records_of(exec_, contact_.history, ids)); }
    std::vector<contact::HistoryRecord> arriving;
    for (const auto& records : decomp::exchange_values(*communicator_, leaving))
    {
        arriving.insert(arriving.end(), records.begin(), records.end());
    }
    contact::add_records(exec_, contact_.history, arriving);
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::send_sleeping_after(const std::vector<std::vector<std::uint32_t>>& migrated_out)
{
    SleepingRows              stay;
    std::vector<SleepingRows> leaving(migrated_out.size());
    for (const SleepingRow& row : read_rows(asleep_))
    {
        const std::size_t to = destination(migrated_out, contact::point_of(row.key));
        (to < leaving.size() ? leaving[to] : stay).push_back(row);
    }
    for (const SleepingRows& arriving : decomp::exchange_values(*communicator_, leaving))
    {
        stay.insert(stay.end(), arriving.begin(), arriving.end());
    }
    write_rows(asleep_, std::move(stay));
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void SandBodyCoupling<Exec, Real>::send_records_after(const std::vector<PointIds>&);                      \
    template void SandBodyCoupling<Exec, Real>::send_sleeping_after(const std::vector<PointIds>&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
