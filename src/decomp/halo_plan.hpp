#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/communicator.hpp"

// Which node pages ranks share, and what each sends and adds.
namespace tread::decomp
{

using PageKeys = std::vector<std::uint64_t>;

/// Whether walls may hold nodes of a page together with those of the pages beside it.
using IsHeld = std::function<bool(std::uint64_t page)>;

/// A node page is shared if several ranks' points reach it. Every rank that does gets the others' parts and adds all of
/// them itself, in rank order, so that all have the same bits and nothing has to come back. A rank whose page walls
/// hold together with one that only others reach gets that one, too.
struct HaloPlan
{
    PageKeys                               extra;      ///< ascending: what the rank must list as well
    PageKeys                               shared;     ///< ascending: what it sends, or gets parts of
    std::vector<std::vector<std::int32_t>> send;       ///< to each rank: numbers in `shared`, ascending
    std::vector<std::int64_t>              arrivals;   ///< parts from each rank
    std::vector<std::int32_t>              first_part; ///< [shared + 1]
    /// What to add for each shared page, in this order: the number of an arrival, counted through the ranks, or -1 =
    /// own.
    std::vector<std::int32_t> part;
    /// Numbers in `shared` of pages whose sums another rank keeps: of the ranks that reach a page the lowest does.
    std::vector<std::int32_t> booked_elsewhere;
};

/// `reached[r]`: node pages that rank r's points may reach, ascending: all of the own rank, of another those at least
/// that are beside the own rank's pages.
HaloPlan plan_halo(int rank, const std::vector<PageKeys>& reached, const IsHeld& is_held);

/// Collective: of every rank the pages that lie in the box around the own ones and one page more; all own ones.
std::vector<PageKeys> pages_nearby(const Communicator& communicator, const PageKeys& own);

} // namespace tread::decomp
