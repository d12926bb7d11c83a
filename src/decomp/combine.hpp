#pragma once

#include "base/communicator.hpp"

namespace tread::decomp
{

/// Collective, of all ranks in rank order: the first `sums` values become their sums, the next `peaks` the largest.
/// All ranks get the same bits.
void combine(const Communicator& communicator, double* values, int sums, int peaks);

} // namespace tread::decomp
