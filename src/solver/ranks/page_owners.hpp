#pragma once

#include "decomp/decomposition.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{

/// Saves or loads the owners of pages, as part of an exact state. Collective. A page that no sand has been in is saved
/// with the owner's complement, a number below 0.
template<class Exec>
void transfer_page_owners(StateFile& file, decomp::Decomposition<Exec>& decomposition)
{
    std::vector<std::uint64_t> keys  = decomposition.owners.keys();
    decomp::PageRanks          ranks = decomposition.owners.ranks();
    const std::int32_t         count = file.communicator().size();
    for (std::size_t page = 0; page < keys.size(); ++page)
    {
        if (decomposition.owners.sand()[page] == 0) { ranks[page] = ~ranks[page]; }
    }
    file.common("ranks/page_key", keys, accept::all(accept::ascending(), accept::distinct()));
    file.common("ranks/page_owner", ranks, accept::all(accept::rows(keys.size()), accept::within(-count, count - 1)));
    if (!file.loads()) { return; }

    std::vector<std::uint64_t> with_sand;
    for (std::size_t page = 0; page < keys.size(); ++page)
    {
        if (ranks[page] < 0) { ranks[page] = ~ranks[page]; }
        else { with_sand.push_back(keys[page]); }
    }
    decomposition.owners.assign({}, {});
    decomposition.owners.assign(keys, ranks);
    decomposition.owners.enter_sand(with_sand);
}

} // namespace tread::solver
