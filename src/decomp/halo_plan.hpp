#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/communicator.hpp"

// Node pages shared between ranks, and what each rank sends and adds.
namespace tread::decomp
{

using PageKeys = std::vector<std::uint64_t>;

/// Whether walls may tie nodes of a page to nodes of neighbouring pages.
using IsHeld = std::function<bool(std::uint64_t page)>;

/// Exchange plan of one rank. A node page is shared if points of several ranks reach it. Every such rank receives the
/// contributions of the others and adds all of them itself, in rank order: all ranks get the same bits, and no result
/// is sent back. A rank also gets pages reached only by others, if walls tie them to one of its own.
struct HaloPlan
{
    PageKeys                               extra;      ///< ascending: pages that the rank must list in addition
    PageKeys                               shared;     ///< ascending: pages that it sends or receives contributions of
    std::vector<std::vector<std::int32_t>> send;       ///< to each rank: numbers in `shared`, ascending
    std::vector<std::int64_t>              arrivals;   ///< contributions from each rank
    std::vector<std::int32_t>              first_part; ///< [shared + 1]
    /// Contributions to each shared page, in order of summation: number of an arrival, counted through the ranks, or -1
    /// for this rank's own.
    std::vector<std::int32_t> part;
    /// Numbers in `shared` of pages that another rank accounts for: the lowest rank that reaches a page does.
    std::vector<std::int32_t> tallied_elsewhere;
};

/// `reached[r]`: node pages that points of rank r may reach, ascending; complete for this rank, for others at least
/// those beside this rank's pages.
HaloPlan plan_halo(int rank, const std::vector<PageKeys>& reached, const IsHeld& is_held);

/// Pages of every rank that lie in the box around this rank's pages, widened by one page; all of its own. Collective.
std::vector<PageKeys> pages_nearby(const Communicator& communicator, const PageKeys& own);

} // namespace tread::decomp
