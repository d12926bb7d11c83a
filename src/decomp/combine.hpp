#pragma once

#include "base/communicator.hpp"

namespace tread::decomp
{

/// Reduces values over all ranks, in rank order: the first `sums` become their sums, the next `peaks` their maxima.
/// Collective. All ranks get the same bits.
void combine(const Communicator& communicator, double* values, int sums, int peaks);

} // namespace tread::decomp
