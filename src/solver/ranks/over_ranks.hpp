#pragma once

#include <cstddef>

#include "base/communicator.hpp"
#include "decomp/combine.hpp"

// Reductions and checks over ranks, which a run on one rank answers without communication: `communicator` is null
// there. Collective otherwise.
namespace tread::solver
{

/// Global maximum of values that are not negative.
double largest_over_ranks(const Communicator* communicator, double value);

/// Global minimum; zeros are ignored, and 0 means that there is no other value.
double smallest_over_ranks(const Communicator* communicator, double value);

/// Sums structs of doubles, in rank order.
template<class Row>
void sum_over_ranks(const Communicator* communicator, Row* rows, std::size_t count)
{
    static_assert(sizeof(Row) % sizeof(double) == 0);
    if (communicator == nullptr) { return; }
    const auto values = static_cast<int>(count * sizeof(Row) / sizeof(double));
    decomp::combine(*communicator, reinterpret_cast<double*>(rows), values, 0);
}
template<class Row>
void sum_over_ranks(const Communicator* communicator, Row& row)
{
    sum_over_ranks(communicator, &row, 1);
}

/// Runs checks of this rank's data; an error on one rank is thrown on all.
template<class Checks>
void check_on_ranks(const Communicator* communicator, Checks checks)
{
    if (communicator != nullptr) { on_every_rank(*communicator, checks); }
    else { checks(); }
}

} // namespace tread::solver
