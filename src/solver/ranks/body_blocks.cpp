#include "solver/ranks/body_blocks.hpp"

#include <algorithm>
#include <utility>

namespace tread::solver
{

BodyBlocks::BodyBlocks(const Communicator& communicator, std::vector<std::int32_t> owned, std::size_t bodies)
    : communicator_(&communicator)
    , owned_(std::move(owned))
{
    const auto ranks = static_cast<std::size_t>(communicator.size()), here = static_cast<std::size_t>(communicator.rank());
    const auto first = [&](std::size_t rank) { return bodies * rank / ranks; };
    std::vector<std::vector<std::int32_t>> leaving(ranks);
    for (std::size_t rank = 0; rank <= ranks; ++rank)
    {
        const auto cut = std::lower_bound(owned_.begin(), owned_.end(), static_cast<std::int32_t>(first(rank)));
        cuts_.push_back(static_cast<std::size_t>(cut - owned_.begin()));
        if (rank > 0) { leaving[rank - 1].assign(owned_.begin() + static_cast<std::ptrdiff_t>(cuts_[rank - 1]), cut); }
    }
    for (const std::vector<std::int32_t>& arriving : decomp::exchange_values(communicator, leaving))
    {
        for (const std::int32_t body : arriving) { places_.push_back(static_cast<std::size_t>(body) - first(here)); }
    }
    size_ = first(here + 1) - first(here);
}

} // namespace tread::solver
