#pragma once

#include "decomp/decomposition.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{

/// Saves or loads the ownership of pages, as part of an exact state. Collective.
template<class Exec>
void transfer_page_owners(StateFile& file, decomp::Decomposition<Exec>& decomposition)
{
    std::vector<std::uint64_t> keys  = decomposition.owners.keys();
    decomp::PageRanks          ranks = decomposition.owners.ranks();
    const auto                 count = static_cast<std::size_t>(file.communicator().size());
    file.common("ranks/page_key", keys, accept::all(accept::ascending(), accept::distinct()));
    file.common("ranks/page_owner", ranks, accept::all(accept::rows(keys.size()), accept::index(count)));
    if (file.loads()) { decomposition.owners.assign(keys, ranks); }
}

} // namespace tread::solver
