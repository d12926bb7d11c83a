#include "decomp/migration.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "decomp/point_columns.hpp"

namespace tread::decomp
{
namespace
{

/// Exact checksum over all ranks, in integers that wrap around.
struct Checksum
{
    std::uint64_t count  = 0;
    std::uint64_t ids    = 0;
    std::uint64_t masses = 0; ///< sum of their bit patterns
};

template<class Exec, class Real>
Checksum checksum(const Communicator& communicator, const mpm::Points<Exec, Real>& points)
{
    Checksum   own;
    const auto ids    = points.id.to_host();
    const auto masses = points.mass.to_host();
    for (std::size_t i = 0; i < static_cast<std::size_t>(points.count); ++i)
    {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &masses[i], sizeof(Real));
        own.count += 1;
        own.ids += ids[i];
        own.masses += bits;
    }
    Checksum   all;
    const auto of_ranks = communicator.gather(std::vector<std::uint64_t>{own.count, own.ids, own.masses});
    for (std::size_t i = 0; i < of_ranks.size(); i += 3)
    {
        all.count += of_ranks[i];
        all.ids += of_ranks[i + 1];
        all.masses += of_ranks[i + 2];
    }
    return all;
}

void require_equal(const Checksum& before, const Checksum& after)
{
    if (before.count == after.count && before.ids == after.ids && before.masses == after.masses) { return; }
    throw NumericalError(fmt::format("points changed when they changed ranks: {} before and {} after, sums of ids {} "
                                     "and {}, of the bits of masses {} and {}",
                                     before.count, after.count, before.ids, after.ids, before.masses, after.masses));
}

} // namespace

template<class Exec, class Real>
Migration<Exec, Real>::Migration(Decomposition<Exec>& decomposition)
    : decomposition_(decomposition)
    , leaving_(decomposition.transport.exec())
    , exchange_(decomposition.transport, "migration messages")
    , ids_(decomposition.transport.exec(), "ids of leaving points")
    , migrated_out_(static_cast<std::size_t>(decomposition.ranks()))
{
}

template<class Exec, class Real>
std::int64_t Migration<Exec, Real>::run(mpm::Points<Exec, Real>& points, const mpm::GridGeometry& geometry,
                                        mpm::OrderScratch<Exec, Real>& scratch)
{
    const Exec&         exec         = decomposition_.transport.exec();
    const Communicator& communicator = decomposition_.communicator;
    const auto          find         = [&] {
        mpm::find_leaving(exec, points, geometry, decomposition_.owners.view(), decomposition_.rank(), leaving_,
                                           scratch);
    };
    find();
    std::vector<std::int32_t> owner    = leaving_.owner.to_host();
    const bool                homeless = std::find(owner.begin(), owner.end(), -1) != owner.end();
    if (communicator.maximum(homeless ? 1 : 0) > 0)
    {
        adopt_pages();
        find();
        owner = leaving_.owner.to_host();
    }
    const std::int64_t moved = communicator.sum(static_cast<std::int64_t>(owner.size()));
    if (moved == 0) { return 0; }

    const bool                             checked = decomposition_.checksums == Checksums::on;
    const Checksum                         before  = checked ? checksum(communicator, points) : Checksum{};
    const std::vector<std::int32_t>        row     = leaving_.row.to_host();
    std::vector<std::vector<std::int32_t>> rows_to(static_cast<std::size_t>(communicator.size()));
    for (std::size_t i = 0; i < row.size(); ++i) { rows_to[static_cast<std::size_t>(owner[i])].push_back(row[i]); }
    note_migrated_out(points, owner);
    exchange_.plan(rows_to);
    exchange_.begin(point_columns(points));
    mpm::remove_leaving(exec, points, leaving_, scratch);
    points.reserve(points.count + exchange_.received());
    exchange_.finish(point_columns(points), points.count);
    points.count += exchange_.received();
    if (checked) { require_equal(before, checksum(communicator, points)); }
    return moved;
}

template<class Exec, class Real>
void Migration<Exec, Real>::note_migrated_out(mpm::Points<Exec, Real>& points, const std::vector<std::int32_t>& owner)
{
    ids_.resize(leaving_.row.size());
    pack_rows(decomposition_.transport.exec(), columns(points.id.data()), leaving_.row.data(), leaving_.row.size(),
              ids_.data());
    const std::vector<std::uint32_t> ids = ids_.to_host();
    for (auto& of_rank : migrated_out_) { of_rank.clear(); }
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
        migrated_out_[static_cast<std::size_t>(owner[i])].push_back(ids[i]);
    }
    for (auto& of_rank : migrated_out_) { std::sort(of_rank.begin(), of_rank.end()); }
}

/// Gathers from all ranks the pages that sand has not been in and their points on each, so that all decide alike. Those
/// without an owner go to the rank with most of these points.
template<class Exec, class Real>
void Migration<Exec, Real>::adopt_pages()
{
    const std::vector<std::int32_t>        owner = leaving_.owner.to_host();
    const std::vector<std::uint64_t>       page  = leaving_.page.to_host();
    std::map<std::uint64_t, std::uint64_t> found;
    for (std::size_t i = 0; i < owner.size(); ++i)
    {
        if (owner[i] < 0) { ++found[page[i]]; }
    }
    std::vector<std::uint64_t> claims; // page, points, rank
    for (const auto& [key, points] : found)
    {
        claims.insert(claims.end(), {key, points, static_cast<std::uint64_t>(decomposition_.rank())});
    }
    claims = decomposition_.communicator.gather(claims);

    struct Claim
    {
        std::uint64_t points;
        std::int32_t  rank;
    };
    std::map<std::uint64_t, Claim> best;
    for (std::size_t i = 0; i < claims.size(); i += 3)
    {
        const Claim claim{claims[i + 1], static_cast<std::int32_t>(claims[i + 2])};
        const auto  at = best.emplace(claims[i], claim).first;
        if (claim.points > at->second.points) { at->second = claim; }
    }
    std::vector<std::uint64_t> keys;
    PageRanks                  ranks;
    for (const auto& [key, claim] : best)
    {
        keys.push_back(key);
        ranks.push_back(claim.rank);
    }
    decomposition_.owners.enter_sand(keys, ranks);
}

#define TREAD_INSTANTIATE(Exec, Real) template class Migration<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::decomp
