#include "solver/ranks/body_blocks.hpp"

#include <algorithm>

namespace tread::solver
{

BodyBlocks::BodyBlocks(const Communicator& communicator, const std::vector<std::int32_t>& owned,
                       const BodyNumbers& numbers)
    : communicator_(&communicator)
    , rows_(numbers.rows_of(owned))
{
    const auto ranks = static_cast<std::size_t>(communicator.size()),
               here  = static_cast<std::size_t>(communicator.rank());
    const auto first = [&](std::size_t rank) { return numbers.bodies() * rank / ranks; };

    std::vector<std::vector<std::int32_t>> leaving(ranks);
    for (std::size_t rank = 0; rank <= ranks; ++rank)
    {
        const auto cut = std::lower_bound(owned.begin(), owned.end(), static_cast<std::int32_t>(first(rank)));
        cuts_.push_back(static_cast<std::size_t>(cut - owned.begin()));
        if (rank > 0) { leaving[rank - 1].assign(owned.begin() + static_cast<std::ptrdiff_t>(cuts_[rank - 1]), cut); }
    }
    for (const std::vector<std::int32_t>& arriving : decomp::exchange_values(communicator, leaving))
    {
        for (const std::int32_t body : arriving) { places_.push_back(static_cast<std::size_t>(body) - first(here)); }
    }
    size_ = first(here + 1) - first(here);
}

} // namespace tread::solver
