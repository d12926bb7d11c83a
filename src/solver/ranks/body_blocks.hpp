#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "decomp/messages.hpp"
#include "solver/ranks/body_numbers.hpp"

namespace tread::solver
{

/// Order of bodies in files: the r-th rank has the r-th block of all bodies, so that ranks write one after the other
/// and none holds them all. Brings rows there from the ranks that own the bodies.
class BodyBlocks
{
public:
    /// One rank, whose block is all bodies.
    BodyBlocks() = default;

    /// `owned`: numbers of this rank's bodies, ascending; each body of the scene is owned by one rank. Collective.
    BodyBlocks(const Communicator& communicator, const std::vector<std::int32_t>& owned, const BodyNumbers& numbers);

    /// Rows of this rank's block. `values`: a row for each of its bodies, of which only those of owned ones are read.
    /// Collective.
    template<class T>
    std::vector<T> rows(std::vector<T> values) const
    {
        if (communicator_ == nullptr) { return values; }
        std::vector<std::vector<T>> leaving(cuts_.size() - 1);
        for (std::size_t rank = 0; rank < leaving.size(); ++rank)
        {
            for (std::size_t i = cuts_[rank]; i < cuts_[rank + 1]; ++i)
            {
                leaving[rank].push_back(values[static_cast<std::size_t>(rows_[i])]);
            }
        }
        std::vector<T> block(size_);
        std::size_t    at = 0;
        for (const std::vector<T>& arriving : decomp::exchange_values(*communicator_, leaving))
        {
            for (const T& value : arriving) { block[places_[at++]] = value; }
        }
        return block;
    }

private:
    const Communicator*       communicator_ = nullptr;
    std::vector<std::int32_t> rows_;     ///< of owned bodies
    std::vector<std::size_t>  cuts_;     ///< [ranks + 1], first of rows_ that belongs to each rank's block
    std::vector<std::size_t>  places_;   ///< in this rank's block, of the rows that arrive
    std::size_t               size_ = 0; ///< of this rank's block
};

} // namespace tread::solver
